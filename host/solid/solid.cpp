#include "host/solid/solid.hpp"

#include <fmt/format.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom_BSplineCurve.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Pln.hxx>
#include <gp_Vec.hxx>
#include <stdexcept>

namespace stiction::host::solid {
namespace {

// Splines of a drawing end where the next one begins within this, mm: nine decimals are printed.
constexpr double joint = 1e-6;

gp_Pnt place_of(const std::array<double, 2>& point, double z = 0.0) { return {point[0], point[1], z}; }

opencascade::handle<Geom_BSplineCurve> curve_of(const Spline& spline) {
  TColgp_Array1OfPnt poles(1, static_cast<int>(spline.points.size()));
  for (std::size_t k = 0; k < spline.points.size(); ++k) poles(static_cast<int>(k) + 1) = place_of(spline.points[k]);
  std::vector<double> knots;
  std::vector<int> times;
  for (const double knot : spline.knots)
    if (!knots.empty() && knot == knots.back())
      ++times.back();
    else
      knots.push_back(knot), times.push_back(1);
  TColStd_Array1OfReal at(1, static_cast<int>(knots.size()));
  TColStd_Array1OfInteger count(1, static_cast<int>(knots.size()));
  for (std::size_t k = 0; k < knots.size(); ++k)
    at(static_cast<int>(k) + 1) = knots[k], count(static_cast<int>(k) + 1) = times[k];
  return new Geom_BSplineCurve(poles, at, count, spline.degree);
}

// The splines in the order in which each begins where the one before ends.
std::vector<Spline> in_order(std::vector<Spline> splines) {
  for (std::size_t k = 0; k < splines.size(); ++k) {
    const auto end = splines[k].points.back();
    const auto distance = [&](const Spline& next) {
      return std::hypot(next.points.front()[0] - end[0], next.points.front()[1] - end[1]);
    };
    const bool last = k + 1 == splines.size();
    auto next = last ? splines.begin()
                     : std::min_element(splines.begin() + static_cast<long>(k) + 1, splines.end(),
                                        [&](const Spline& a, const Spline& b) { return distance(a) < distance(b); });
    if (distance(*next) > joint)
      throw std::runtime_error(
          fmt::format("found an outline that is open by {:.3g} mm at x {:.6g} mm, y {:.6g} mm; expected a closed one",
                      distance(*next), end[0], end[1]));
    // One and the same place for both.
    next->points.front() = end;
    if (!last) std::swap(splines[k + 1], *next);
  }
  return splines;
}

template <class Visit>
void for_each(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind, Visit visit) {
  for (TopExp_Explorer at(shape, kind); at.More(); at.Next()) visit(at.Current());
}

}  // namespace

TopoDS_Shape raised(const std::vector<Spline>& outline, double width) {
  BRepBuilderAPI_MakeWire wire;
  for (const Spline& spline : in_order(outline)) wire.Add(BRepBuilderAPI_MakeEdge(curve_of(spline)));
  if (!wire.IsDone() || !BRep_Tool::IsClosed(wire.Wire()))
    throw std::runtime_error("found an outline whose splines make no closed wire; expected one");
  const BRepBuilderAPI_MakeFace face(gp_Pln(gp::Origin(), gp::DZ()), wire.Wire());
  return BRepPrimAPI_MakePrism(face.Face(), gp_Vec(0.0, 0.0, width)).Shape();
}

SolidCheck check(const TopoDS_Shape& shape) {
  SolidCheck found;
  found.valid = BRepCheck_Analyzer(shape).IsValid();
  found.closed = true;
  for_each(shape, TopAbs_SOLID, [&](const TopoDS_Shape&) { ++found.solids; });
  for_each(shape, TopAbs_SHELL,
           [&](const TopoDS_Shape& shell) { found.closed = found.closed && BRep_Tool::IsClosed(shell); });
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  found.volume = properties.Mass();
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, false, false);
  double low[3], high[3];
  box.Get(low[0], low[1], low[2], high[0], high[1], high[2]);
  found.height = high[2] - low[2];
  return found;
}

double largest_distance(const TopoDS_Shape& shape, const std::vector<std::array<double, 2>>& places) {
  const double middle = 0.5 * check(shape).height;
  // The faces alone: within a solid everything has the distance 0.
  TopoDS_Compound faces;
  BRep_Builder builder;
  builder.MakeCompound(faces);
  for_each(shape, TopAbs_FACE, [&](const TopoDS_Shape& face) { builder.Add(faces, face); });
  double largest = 0.0;
  for (const auto& place : places) {
    const BRepExtrema_DistShapeShape distance(BRepBuilderAPI_MakeVertex(place_of(place, middle)).Vertex(), faces);
    if (!distance.IsDone()) throw std::runtime_error("found no distance of a point from the solid; expected one");
    largest = std::max(largest, distance.Value());
  }
  return largest;
}

}  // namespace stiction::host::solid
