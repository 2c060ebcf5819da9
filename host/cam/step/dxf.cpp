#include <fmt/format.h>

#include <cmath>

#include "host/cam/step/outline.hpp"
#include "host/cam/step/shop_files.hpp"

namespace stiction::host::step {
namespace {

struct Layer {
  const char* name;
  int colour;
};
constexpr Layer layers[] = {{"CAM_1", 5},     {"CAM_2", 1},     {"PITCH_1", 140}, {"PITCH_2", 30},
                            {"ROLLERS_1", 4}, {"ROLLERS_2", 6}, {"ZERO_PIN", 3},  {"NOTES", 7}};

class DxfWriter {
 public:
  explicit DxfWriter(DxfVersion version) : modern_(version == DxfVersion::r2000) {}

  void head(const std::vector<std::string>& lines) {
    for (const auto& line : lines) pair(999, line);
    section("HEADER");
    pair(9, "$ACADVER"), pair(1, modern_ ? "AC1015" : "AC1009");
    if (modern_) {
      pair(9, "$HANDSEED"), pair(5, "FFFF");
      pair(9, "$INSUNITS"), pair(70, "4");
    }
    end_section();
    if (modern_) section("CLASSES"), end_section();
    tables();
    blocks();
    section("ENTITIES");
    for (std::size_t k = 0; k < lines.size(); ++k) note(lines[k], -110.0 - 4.0 * static_cast<double>(k));
  }

  std::string finish() {
    end_section();
    if (modern_) objects();
    pair(0, "EOF");
    return std::move(text_);
  }

  void circle(const std::string& layer, Point centre, double radius) {
    entity("CIRCLE", layer, "AcDbCircle");
    point(10, centre);
    pair(40, number(1e3 * radius));
  }

  void line(const std::string& layer, Point from, Point to) {
    entity("LINE", layer, "AcDbLine");
    point(10, from);
    point(11, to);
  }

  // A closed outline of arcs.
  void outline(const std::string& layer, const std::vector<ArcCorner>& corners) {
    if (modern_) {
      entity("LWPOLYLINE", layer, "AcDbPolyline");
      pair(90, fmt::format("{}", corners.size())), pair(70, "1");
      for (const ArcCorner& corner : corners) {
        pair(10, number(1e3 * corner.place.real())), pair(20, number(1e3 * corner.place.imag()));
        pair(42, fmt::format("{:.12g}", corner.bulge));
      }
      return;
    }
    entity("POLYLINE", layer, "AcDb2dPolyline");
    pair(66, "1"), pair(10, "0.0"), pair(20, "0.0"), pair(30, "0.0"), pair(70, "1");
    for (const ArcCorner& corner : corners) {
      pair(0, "VERTEX"), pair(8, layer);
      point(10, corner.place);
      pair(42, fmt::format("{:.12g}", corner.bulge));
    }
    pair(0, "SEQEND"), pair(8, layer);
  }

  // A cubic curve through nodes as a spline with double knots: between the control points of two elements lies a node.
  void spline(const std::string& layer, const std::vector<CurveNode>& nodes) {
    entity("SPLINE", layer, "AcDbSpline");
    const std::size_t elements = nodes.size() - 1;
    pair(210, "0.0"), pair(220, "0.0"), pair(230, "1.0");
    pair(70, "8"), pair(71, "3");
    pair(72, fmt::format("{}", 2 * elements + 6)), pair(73, fmt::format("{}", 2 * elements + 2)), pair(74, "0");
    pair(42, "0.0000000001"), pair(43, "0.0000000001");
    for (std::size_t k = 0; k < nodes.size(); ++k)
      for (int times = k == 0 || k == elements ? 4 : 2; times > 0; --times)
        pair(40, fmt::format("{:.15g}", nodes[k].angle - nodes.front().angle));
    point(10, nodes.front().place);
    for (std::size_t k = 0; k < elements; ++k) {
      const double third = (nodes[k + 1].angle - nodes[k].angle) / 3.0;
      point(10, nodes[k].place + third * nodes[k].slope);
      point(10, nodes[k + 1].place - third * nodes[k + 1].slope);
    }
    point(10, nodes.back().place);
  }

 private:
  static std::string number(double value) { return fmt::format("{:.9f}", value); }
  void pair(int code, std::string_view value) { text_ += fmt::format("{:>3}\n{}\n", code, value); }
  void point(int code, Point at) {
    pair(code, number(1e3 * at.real()));
    pair(code + 10, number(1e3 * at.imag()));
    pair(code + 20, "0.0");
  }
  void section(std::string_view name) { pair(0, "SECTION"), pair(2, name); }
  void end_section() { pair(0, "ENDSEC"); }
  std::string handle() { return fmt::format("{:X}", next_++); }

  void entity(std::string_view kind, const std::string& layer, std::string_view subclass) {
    pair(0, kind);
    if (modern_) pair(5, handle()), pair(330, "1F"), pair(100, "AcDbEntity");
    pair(8, layer);
    if (modern_) pair(100, subclass);
  }

  void note(const std::string& words, double y) {
    entity("TEXT", "NOTES", "AcDbText");
    point(10, {-0.1, 1e-3 * y});
    pair(40, "3.0"), pair(1, words);
    if (modern_) pair(100, "AcDbText");
  }

  // A table of symbols; in R2000 with handles and subclass marks, `own` of its rows.
  void open_table(std::string_view name, std::string_view table_handle, std::size_t rows) {
    pair(0, "TABLE"), pair(2, name);
    if (modern_) pair(5, table_handle), pair(330, "0"), pair(100, "AcDbSymbolTable");
    pair(70, fmt::format("{}", rows));
  }
  void row(std::string_view name, std::string_view row_handle, std::string_view table_handle, std::string_view own) {
    pair(0, name);
    if (!modern_) return;
    pair(name == "DIMSTYLE" ? 105 : 5, row_handle), pair(330, table_handle);
    pair(100, "AcDbSymbolTableRecord"), pair(100, own);
  }

  void tables() {
    section("TABLES");
    if (modern_) {
      open_table("VPORT", "8", 0), pair(0, "ENDTAB");
    }
    open_table("LTYPE", "5", modern_ ? 3 : 1);
    const char* const types[] = {"ByBlock", "ByLayer", "Continuous"};
    for (int k = modern_ ? 0 : 2; k < 3; ++k) {
      row("LTYPE", fmt::format("{:X}", 0x14 + k), "5", "AcDbLinetypeTableRecord");
      pair(2, types[k]), pair(70, "0"), pair(3, ""), pair(72, "65"), pair(73, "0"), pair(40, "0.0");
    }
    pair(0, "ENDTAB");
    open_table("LAYER", "2", std::size(layers) + 1);
    for (std::size_t k = 0; k <= std::size(layers); ++k) {
      row("LAYER", fmt::format("{:X}", 0x100 + k), "2", "AcDbLayerTableRecord");
      pair(2, k == 0 ? "0" : layers[k - 1].name), pair(70, "0");
      pair(62, fmt::format("{}", k == 0 ? 7 : layers[k - 1].colour)), pair(6, "Continuous");
    }
    pair(0, "ENDTAB");
    open_table("STYLE", "3", 1);
    row("STYLE", "11", "3", "AcDbTextStyleTableRecord");
    pair(2, "Standard"), pair(70, "0"), pair(40, "0.0"), pair(41, "1.0"), pair(50, "0.0"), pair(71, "0");
    pair(42, "2.5"), pair(3, "txt"), pair(4, ""), pair(0, "ENDTAB");
    if (modern_) {
      open_table("VIEW", "6", 0), pair(0, "ENDTAB");
      open_table("UCS", "7", 0), pair(0, "ENDTAB");
      open_table("APPID", "9", 1), row("APPID", "12", "9", "AcDbRegAppTableRecord");
      pair(2, "ACAD"), pair(70, "0"), pair(0, "ENDTAB");
      open_table("DIMSTYLE", "A", 1), row("DIMSTYLE", "27", "A", "AcDbDimStyleTableRecord");
      pair(2, "Standard"), pair(70, "0"), pair(0, "ENDTAB");
      open_table("BLOCK_RECORD", "1", 2);
      row("BLOCK_RECORD", "1F", "1", "AcDbBlockTableRecord"), pair(2, "*Model_Space");
      row("BLOCK_RECORD", "1B", "1", "AcDbBlockTableRecord"), pair(2, "*Paper_Space");
      pair(0, "ENDTAB");
    }
    end_section();
  }

  void blocks() {
    section("BLOCKS");
    if (modern_)
      for (const auto& [name, record, begin, end] :
           {std::array{"*Model_Space", "1F", "20", "21"}, std::array{"*Paper_Space", "1B", "1C", "1D"}}) {
        pair(0, "BLOCK"), pair(5, begin), pair(330, record), pair(100, "AcDbEntity"), pair(8, "0");
        pair(100, "AcDbBlockBegin"), pair(2, name), pair(70, "0"), pair(10, "0.0"), pair(20, "0.0"), pair(30, "0.0");
        pair(3, name), pair(1, "");
        pair(0, "ENDBLK"), pair(5, end), pair(330, record), pair(100, "AcDbEntity"), pair(8, "0");
        pair(100, "AcDbBlockEnd");
      }
    end_section();
  }

  void objects() {
    section("OBJECTS");
    pair(0, "DICTIONARY"), pair(5, "C"), pair(330, "0"), pair(100, "AcDbDictionary"), pair(281, "1");
    pair(3, "ACAD_GROUP"), pair(350, "D");
    pair(0, "DICTIONARY"), pair(5, "D"), pair(330, "C"), pair(100, "AcDbDictionary"), pair(281, "1");
    end_section();
  }

  bool modern_;
  int next_ = 0x200;
  std::string text_;
};

}  // namespace

std::string dxf_text(const StepProject& project, const StepSynthesis& made, DxfVersion version,
                     const FileOrigin& origin) {
  const StepMechanism& m = project.mechanism;
  DxfWriter dxf(version);
  auto lines = detail::head_lines(project, "drawing", origin);
  lines.insert(lines.end() - 1, fmt::format("rollers: {:.6g} mm wide", 1e3 * m.roller_width));
  lines.insert(
      lines.end() - 1,
      made.symmetry.holds()
          ? fmt::format("zero pin: on the axis about which cam 2 is the mirrored cam 1, at {:.4f} deg and half "
                        "a turn from it",
                        made.symmetry.axis / degree)
          : "zero pin: at the zero; the cams have profiles of their own and are not mirrored");
  dxf.head(lines);
  for (const StepProfile& profile : made.profiles) {
    const std::string cam = fmt::format("{}", profile.row + 1);
    if (version == DxfVersion::r12)
      dxf.outline("CAM_" + cam, arcs_of(profile, project.chord));
    else
      for (const auto& nodes : curves_of(profile, project.chord)) dxf.spline("CAM_" + cam, nodes);
    // The paths of the rollers, where they touch.
    std::vector<ArcCorner> path;
    for (const ProfilePoint& point : made.cut[static_cast<std::size_t>(profile.row)].points)
      path.push_back({point.place() - m.roller_radius * point.normal});
    dxf.outline("PITCH_" + cam, path);
    for (int k = 0; k < m.rollers; ++k)
      dxf.circle("ROLLERS_" + cam, roller_at(m, m.base(profile.row) + k * m.pitch(), 0.0, made.lift.at(0.0)).centre,
                 m.roller_radius);
  }
  const Point pin =
      sim::in_direction(1.1 * made.profiles[0].largest_radius, made.symmetry.holds() ? made.symmetry.axis : 0.0);
  dxf.line("ZERO_PIN", -pin, pin);
  return detail::with_checksum(dxf.finish());
}

}  // namespace stiction::host::step
