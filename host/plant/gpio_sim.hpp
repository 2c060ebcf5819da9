// Plays what is wired to the lines of a simulated gpiochip (the kernel's gpio-sim): an incremental encoder with its
// index mark, and switches. What the other side drives can be read. The chip is made through configfs beforehand
// (Documentation/admin-guide/gpio/gpio-sim.rst); its lines are then a folder each,
// /sys/devices/platform/gpio-sim.0/gpiochip0/sim_gpioN, with `pull` to set and `value` to read.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace stiction::plant {

class GpioSim {
 public:
  // The folder of the chip with this label or name, none where there is no such simulated chip.
  static std::optional<std::filesystem::path> find(const std::string& chip);

  // Throws std::runtime_error.
  explicit GpioSim(std::filesystem::path folder);
  ~GpioSim();
  GpioSim(const GpioSim&) = delete;
  GpioSim& operator=(const GpioSim&) = delete;

  void set(int line, bool high);  // the electrical level of an input; throws std::runtime_error
  bool driven(int line);          // that of an output

 private:
  struct Files {
    int pull = -1;
    int value = -1;
    int level = -1;  // last set; -1: unknown
  };
  Files& files(int line);

  std::filesystem::path folder_;
  std::map<int, Files> lines_;
};

// The tracks of an incremental encoder: A leads B in the positive direction, the index is high for one count.
class EncoderLines {
 public:
  struct Wiring {
    int a = -1, b = -1;
    int index = -1;                // -1: none
    std::int64_t index_every = 0;  // counts from one mark to the next, the first at 0; 0: a single mark at 0
  };

  // Levels as at `count`.
  EncoderLines(GpioSim& chip, const Wiring& wiring, std::int64_t count = 0);

  void step(bool forward);           // one edge of A or B, and what the index does there
  void move_to(std::int64_t count);  // by steps
  std::int64_t count() const { return count_; }

 private:
  void apply();

  GpioSim& chip_;
  Wiring wiring_;
  std::int64_t count_;
};

// A switch that is reached from a count on, upwards or downwards.
struct SwitchLine {
  int line = -1;
  std::int64_t at = 0;
  bool upwards = true;
  bool active_low = false;  // a contact that opens: low while it is reached

  void update(GpioSim& chip, std::int64_t count) const {
    const bool reached = upwards ? count >= at : count <= at;
    chip.set(line, reached != active_low);
  }
};

}  // namespace stiction::plant
