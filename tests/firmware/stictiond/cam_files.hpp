// Tables of real motions in files, for a drive that reads them.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "sim/cam/motion.hpp"
#include "sim/cam/segment_table.hpp"

namespace stiction::test {

// Rise, rest, return, rest of a linear axis behind a line shaft, from `start` (m) on.
inline sim::cam::Cam linear_cam(double stroke, double start = 0.0, const std::string& law = "3-4-5") {
  const double turn = 2.0 * std::numbers::pi;
  sim::cam::Cam cam{.name = "a", .slave = sim::cam::Coordinate::linear, .start = start};
  cam.segments = {{.length = 0.4 * turn, .stroke = stroke, .law = law},
                  {.length = 0.1 * turn},
                  {.length = 0.4 * turn, .stroke = -stroke, .law = law},
                  {.length = 0.1 * turn}};
  return cam;
}

// A folder for tables that ends with this.
class CamFiles {
 public:
  CamFiles() : folder_(std::filesystem::temp_directory_path() / ("stiction-cams-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  CamFiles(const CamFiles&) = delete;
  CamFiles& operator=(const CamFiles&) = delete;
  ~CamFiles() { std::filesystem::remove_all(folder_); }

  // As `stiction cam table` writes it.
  std::string add(const sim::cam::Cam& cam) {
    motions.push_back(sim::cam::compose(cam));
    return write(sim::cam::table_within(motions.back(), sim::cam::table_tolerance(motions.back())).bytes);
  }
  std::string write(const std::vector<std::uint8_t>& bytes) {
    const auto file = folder_ / (std::to_string(count_++) + ".scam");
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file.string();
  }

  std::vector<sim::cam::Motion> motions;

 private:
  std::filesystem::path folder_;
  int count_ = 0;
};

}  // namespace stiction::test
