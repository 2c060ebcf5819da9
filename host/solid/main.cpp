// stiction-solids: the cams of a folder of `stiction cam step` as STEP solids, and what OpenCASCADE says of such a
// file.
#include <fmt/format.h>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>

#include "host/solid/drawing.hpp"
#include "host/solid/solid.hpp"
#include "host/solid/step_file.hpp"

namespace {

using namespace stiction::host::solid;

constexpr const char* usage =
    "usage: stiction-solids FOLDER [WIDTH]\n"
    "         FOLDER  that `stiction cam step --out` has written: its cams_r2000.dxf becomes cam_1.step and "
    "cam_2.step\n"
    "         WIDTH   of both cams in mm [that of the rollers]\n"
    "       stiction-solids --check FILE.step TABLE.csv\n"
    "         what a STEP file holds, and how far the points of TABLE.csv (angle in deg, radius in mm) are from it\n";

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("{}: found no such file; expected one", file.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

int write(const std::filesystem::path& folder, double width) {
  const auto file = folder / "cams_r2000.dxf";
  const Drawing drawing = read_drawing(file.string(), content(file));
  for (std::size_t cam = 0; cam < 2; ++cam) {
    const double wide = width > 0.0 ? width : drawing.widths[cam];
    if (!(wide > 0.0))
      throw std::runtime_error(
          fmt::format("{}: found no width of the rollers; expected one, or a WIDTH", file.string()));
    const TopoDS_Shape solid = raised(drawing.outlines[cam], wide);
    const std::string name = fmt::format("cam_{}", cam + 1);
    auto head = drawing.head;
    std::erase_if(head, [](const std::string& line) { return line.find("CRC-32") != std::string::npos; });
    head.insert(head.begin(),
                fmt::format("cam {}, {:.6g} mm wide along z, from the drawing with these lines", cam + 1, wide));
    const auto made = folder / (name + ".step");
    write_step(solid, name, head, made.string());
    const SolidCheck found = check(solid);
    fmt::print("{}: {:.1f} cm^3, {}\n", made.string(), 1e-3 * found.volume,
               found.valid ? "a valid solid" : "NOT a valid solid");
    if (!found.valid) return 1;
  }
  return 0;
}

// Angle and radius of every row; the separator is a comma.
std::vector<std::array<double, 2>> places_of(const std::string& table) {
  std::vector<std::array<double, 2>> places;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    double angle = 0.0, radius = 0.0;
    char comma = 0;
    if (!(cells >> angle >> comma >> radius)) continue;
    const double at = angle * std::numbers::pi / 180.0;
    places.push_back({radius * std::cos(at), radius * std::sin(at)});
  }
  return places;
}

int say(const std::string& file, const std::string& table) {
  const TopoDS_Shape shape = read_step(file);
  const SolidCheck found = check(shape);
  const auto places = places_of(content(table));
  fmt::print(
      "{{\"solids\": {}, \"valid\": {}, \"closed\": {}, \"volume_mm3\": {:.9g}, \"height_mm\": {:.9g}, \"points\": {}, "
      "\"distance_um\": {:.6g}}}\n",
      found.solids, found.valid, found.closed, found.volume, found.height, places.size(),
      1e3 * largest_distance(shape, places));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  try {
    const std::string first = argc > 1 ? argv[1] : "";
    if (first == "--check" && argc == 4) return say(argv[2], argv[3]);
    if ((argc == 2 || argc == 3) && !first.starts_with("-"))
      return write(first, argc == 3 ? std::strtod(argv[2], nullptr) : 0.0);
    fmt::print(stderr, "{}", usage);
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "stiction-solids: {}\n", error.what());
  } catch (const Standard_Failure& failure) {
    fmt::print(stderr, "stiction-solids: OpenCASCADE: {}\n", failure.GetMessageString());
  }
  return 1;
}
