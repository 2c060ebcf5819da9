#include "host/solid/drawing.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace stiction::host::solid {
namespace {

std::string trimmed(const std::string& line) {
  const auto begin = line.find_first_not_of(" \t\r"), end = line.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
}

// "rollers: 12 mm wide"
double width_in(const std::string& comment) {
  const std::string begin = "rollers: ";
  return comment.rfind(begin, 0) == 0 ? std::strtod(comment.c_str() + begin.size(), nullptr) : 0.0;
}

// A pair of the format at a time: a group code, then its value.
class Reader {
 public:
  explicit Reader(Drawing& drawing) : drawing_(drawing) {}

  void take(int code, const std::string& value) {
    if (code == 999) {
      drawing_.head.push_back(value);
      if (const double width = width_in(value); width > 0.0) drawing_.widths = {width, width};
      return;
    }
    if (code == 0) {
      finish();
      inside_ = value == "SPLINE";
      return;
    }
    if (!inside_) return;
    const double number = std::strtod(value.c_str(), nullptr);
    if (code == 8) layer_ = value;
    if (code == 71) spline_.degree = static_cast<int>(number);
    if (code == 40) spline_.knots.push_back(number);
    if (code == 10) spline_.points.push_back({number, 0.0});
    if (code == 20 && !spline_.points.empty()) spline_.points.back()[1] = number;
  }

  void finish() {
    if (inside_ && layer_ == "CAM_1") drawing_.outlines[0].push_back(spline_);
    if (inside_ && layer_ == "CAM_2") drawing_.outlines[1].push_back(spline_);
    spline_ = {};
    inside_ = false;
  }

 private:
  Drawing& drawing_;
  Spline spline_;
  std::string layer_;
  bool inside_ = false;
};

void require_whole(const std::string& file, const Spline& spline) {
  if (spline.degree > 0 && spline.points.size() > static_cast<std::size_t>(spline.degree) &&
      spline.knots.size() == spline.points.size() + static_cast<std::size_t>(spline.degree) + 1)
    return;
  throw std::runtime_error(
      fmt::format("{}: found a spline of degree {} with {} points and {} knots; expected points + degree + 1 knots",
                  file, spline.degree, spline.points.size(), spline.knots.size()));
}

}  // namespace

Drawing read_drawing(const std::string& file, const std::string& text) {
  Drawing drawing;
  Reader reader(drawing);
  std::istringstream lines(text);
  for (std::string code, value; std::getline(lines, code) && std::getline(lines, value);)
    reader.take(std::atoi(code.c_str()), trimmed(value));
  reader.finish();
  for (std::size_t cam = 0; cam < 2; ++cam) {
    if (drawing.outlines[cam].empty())
      throw std::runtime_error(
          fmt::format("{}: found no spline on the layer CAM_{}; expected the drawing cams_r2000.dxf that `stiction cam "
                      "step` writes",
                      file, cam + 1));
    for (const Spline& spline : drawing.outlines[cam]) require_whole(file, spline);
  }
  return drawing;
}

}  // namespace stiction::host::solid
