// What the desk computes of a motion on a machine, as files of doubles for studio_bits.mjs: by the functions of the
// commands, not by the studio's own.
// usage: write_studio_values MOTION MACHINE SPEED OUT      speed in rad/s
//        write_studio_values --rewrite MOTION              prints the motion as the commands write it
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "host/simulate/cam_run.hpp"
#include "host/simulate/stand_run.hpp"
#include "host/studio/number_check.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace {

namespace host = stiction::host;
namespace cam = stiction::sim::cam;

constexpr int cycles = 3;
constexpr std::size_t arguments = 1'000'000;

void write(const std::filesystem::path& file, const std::vector<double>& values) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(8 * values.size()));
}

std::vector<double> record_of(const host::AxisLog& axis) {
  std::vector<double> rows;
  for (std::size_t k = 0; k < axis.x.size(); ++k)
    rows.insert(rows.end(), {axis.master[k], axis.x_set[k], axis.x[k], axis.v[k]});
  return rows;
}

// Both sides of every joint and 600 places between, as a chart has them.
std::vector<double> profile_of(const cam::Curve& curve) {
  std::vector<double> rows;
  for (const auto& piece : curve.pieces()) {
    const int count = std::max(8, static_cast<int>(600.0 * piece.length() / curve.length()));
    for (int k = 0; k <= count; ++k) {
      const double x = k == count ? piece.end : piece.begin + piece.length() * k / count;
      rows.insert(rows.end(),
                  {x, piece.derivative(x, 0), piece.derivative(x, 1), piece.derivative(x, 2), piece.derivative(x, 3)});
    }
  }
  return rows;
}

}  // namespace

int main(int count, char** given) {
  if (count == 3 && std::string(given[1]) == "--rewrite") {
    fmt::print("{}", cam::motion_text(cam::read_motion_file(given[2])));
    return 0;
  }
  if (count != 5) {
    fmt::print(stderr, "usage: write_studio_values MOTION MACHINE SPEED OUT\n");
    return 2;
  }
  const auto cams = cam::read_motion_file(given[1]);
  const auto motion = compose(cams.front());
  const auto machine = stiction::sim::read_machine(given[2]);
  const double speed = std::strtod(given[3], nullptr);
  const std::filesystem::path out = given[4];
  std::filesystem::create_directories(out);
  std::ofstream(out / "motion.toml", std::ios::binary) << cam::motion_text(cams);
  write(out / "profile.bin", profile_of(motion.curve));
  using stiction::FixedSignals;
  try {
    const auto run = host::run_cam<FixedSignals>(machine, motion, {.master_speed = speed, .cycles = cycles});
    write(out / "follow.bin", record_of(run.log.axes.front()));
  } catch (const stiction::machine::ConfigurationError&) {  // a motion that jumps, which the drive's cam refuses
  }
  const auto stand = host::run_stand<FixedSignals>(machine, motion, {.master_speed = speed, .cycles = cycles});
  write(out / "stand.bin", record_of(stand.log.axes.front()));
  for (int function = 0; function < 7; ++function)
    write(out / fmt::format("numbers-{}.bin", function),
          host::number_values(static_cast<host::NumberFunction>(function), arguments));
}
