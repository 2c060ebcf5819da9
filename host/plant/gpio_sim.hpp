// Plays what is wired to the lines of a simulated gpiochip (the kernel's gpio-sim): an incremental encoder with its
// index mark, and switches. What the other side drives can be read. The chip is made through configfs beforehand
// (Documentation/admin-guide/gpio/gpio-sim.rst); its lines are then a folder each,
// /sys/devices/platform/gpio-sim.0/gpiochip0/sim_gpioN, with `pull` to set and `value` to read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

namespace stiction::plant {

// A chip, line or folder that cannot be had; what() says which and why.
class GpioSimError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class GpioSim {
 public:
  // The folder of the chip with this label or name, none where there is no such simulated chip.
  static std::optional<std::filesystem::path> find(const std::string& chip);

  // Throws GpioSimError.
  explicit GpioSim(std::filesystem::path folder);
  ~GpioSim();
  GpioSim(const GpioSim&) = delete;
  GpioSim& operator=(const GpioSim&) = delete;

  void set(int line, bool high);  // the electrical level of an input; throws GpioSimError
  bool driven(int line);          // that of an output; throws as well

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

// Where an encoder's index is high, for one count.
struct IndexMarks {
  std::int64_t at = 0;
  std::int64_t every = 0;  // counts from one mark to the next; 0: a single one
};

// The tracks of an incremental encoder: A leads B in the positive direction.
class EncoderLines {
 public:
  struct Wiring {
    int a = -1, b = -1;
    int index = -1;  // -1: none
    bool index_active_low = false;
    IndexMarks marks{};
  };

  // Levels as at `count`. `chip`: must outlive this; `wiring`: numbers of the lines.
  EncoderLines(GpioSim& chip, const Wiring& wiring, std::int64_t count = 0);

  void step(bool forward);           // one edge of A or B, and what the index does there
  void move_to(std::int64_t count);  // by steps
  // Both tracks change, which is no step: two counts that came at once. In simulated time they have one time stamp.
  void slip();
  // The levels of a place that was not reached by steps.
  void reconnect(std::int64_t count);
  std::int64_t count() const { return count_; }

 private:
  void apply();

  GpioSim* chip_;
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
