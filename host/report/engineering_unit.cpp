// Engineering units: see engineering_unit.hpp.
#include "host/report/engineering_unit.hpp"

#include <array>
#include <numbers>

namespace stiction::host {
namespace {

// The first row of the SI unit whose `from` does not exceed the size.
struct Row {
  std::string_view si;
  double from;
  std::string_view unit;
  double factor;
};
constexpr std::array rows{
    Row{"1", 0.0, "", 1.0},
    Row{"m", 1e-3, "mm", 1e3},
    Row{"m", 1e-6, "µm", 1e6},
    Row{"m", 0.0, "nm", 1e9},
    Row{"rad", 1e-3, "deg", 180.0 / std::numbers::pi},
    Row{"rad", 0.0, "µrad", 1e6},
    Row{"kg m^2", 1e-2, "kg m²", 1.0},
    Row{"kg m^2", 0.0, "kg cm²", 1e4},
    Row{"s", 1.0, "s", 1.0},
    Row{"s", 1e-3, "ms", 1e3},
    Row{"s", 0.0, "µs", 1e6},
    Row{"m/s", 0.02, "m/min", 60.0},
    Row{"m/s", 0.0, "mm/s", 1e3},
    Row{"m/s^2", 0.0, "m/s²", 1.0},
    Row{"N/m", 1e4, "N/µm", 1e-6},
    Row{"H", 0.0, "mH", 1e3},
    Row{"Ohm", 0.0, "Ω", 1.0},
    Row{"1/s", 0.0, "(m/min)/mm", 0.06},  // K_v is the only rate
};

}  // namespace

EngineeringUnit engineering_unit(std::string_view si, double size) {
  // A file's "1 us" is 9.99..e-7 s when it comes through the units' library.
  for (const Row& row : rows)
    if (row.si == si && size * (1.0 + 1e-9) >= row.from) return {std::string(row.unit), row.factor};
  return {std::string(si), 1.0};
}

}  // namespace stiction::host
