// For the tests of the machine file: a small valid machine as text, to be damaged, and its reading through a file.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "sim/machine_file.hpp"

namespace stiction::machine::test {

inline const std::string small_machine = R"(schema = "stiction.machine/1"
name = "small"
[axis.B]
mass = "95 kg"
travel = "250 mm"
max_velocity = "0.2 m/s"
max_acceleration = "2 m/s^2"
[axis.B.motor]
model = "force"
force_constant = "35 N/V"
[axis.B.inverter]
dead_time = "0 us"
voltage_limit = "10 V"
[axis.B.encoder]
increment = "50 nm"
velocity = "mean-difference"
[axis.B.position_controller]
gain = "160 1/s"
[axis.B.velocity_controller]
gain = "243 V s/m"
[axis.B.friction]
use = "lugre"
[axis.B.friction.lugre]
coulomb = "20 N"
viscous = "200 N s/m"
stribeck_velocity = "1 mm/s"
stiffness = "1e6 N/m"
damping_ratio = 0.1
)";

inline std::filesystem::path shipped_machine() {
  return std::filesystem::path(STICTION_SOURCE_DIR) / "firmware" / "machine" / "shipped" / "mcfv5050ln.toml";
}

inline std::filesystem::path shipped_feed_drive() { return shipped_machine().parent_path() / "stick-slip-feed.toml"; }

// `text` with the one place `from` replaced; the test fails where there is none.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "no \"" << from << "\" in the text";
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// A file with this text in a folder of its own: tests of several builds may run at once.
class MachineFileOnDisk {
 public:
  explicit MachineFileOnDisk(const std::string& text)
      : folder_(std::filesystem::path(testing::TempDir()) /
                ("stiction-machine-" + std::to_string(::getpid()) + "-" + std::to_string(count++))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(path()) << text;
  }
  ~MachineFileOnDisk() { std::filesystem::remove_all(folder_); }
  MachineFileOnDisk(const MachineFileOnDisk&) = delete;
  MachineFileOnDisk& operator=(const MachineFileOnDisk&) = delete;

  std::filesystem::path path() const { return folder_ / "machine.toml"; }

 private:
  static inline int count = 0;
  std::filesystem::path folder_;
};

inline Machine read_text(const std::string& text, const ReadOptions& options = {}) {
  return sim::read_machine(MachineFileOnDisk(text).path(), options);
}

// The message with which reading fails, with "FILE" for the path; "accepted" when it does not fail.
inline std::string error_of(const std::string& text, const ReadOptions& options = {}) {
  const MachineFileOnDisk file(text);
  try {
    sim::read_machine(file.path(), options);
    return "accepted";
  } catch (const MachineFileError& error) {
    std::string message = error.what();
    if (message.starts_with(file.path().string())) message.replace(0, file.path().string().size(), "FILE");
    return message;
  }
}

// As error_of, for the small machine with one change.
inline std::string error_after(const std::string& from, const std::string& to) {
  return error_of(replaced(small_machine, from, to));
}

// As error_of, for a shipped machine with values from the command line.
inline std::string error_of_set(std::vector<std::string> set, const std::string& experiment = {},
                                const std::filesystem::path& machine = shipped_machine()) {
  try {
    sim::read_machine(machine, {.experiment = experiment, .set = std::move(set)});
    return "accepted";
  } catch (const MachineFileError& error) {
    return error.what();
  }
}

}  // namespace stiction::machine::test
