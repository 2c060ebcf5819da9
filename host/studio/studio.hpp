// The cam studio: a motion that is edited, its curves, what it breaks, and the machine that follows it. The same source
// is compiled for the desk and, without files, for the page (wasm/), so that what the page shows is what the commands
// compute.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/cam/duty.hpp"
#include "host/studio/step_studio.hpp"
#include "host/studio/studio_table.hpp"
#include "sim/cam/check.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

// What one run of the simulated axis shows of a motion.
struct StudioRun {
  // Of the last cycle: the master within it, the following error of the load, the motor's effort where the run has it.
  StudioTable ticks;
  // Of every measured cycle, as the log of the run: the master, set-point and position of the motor, its speed.
  StudioTable record;
  double peak_error = 0.0, mean_error = 0.0;   // in the slave's unit
  double peak_effort = 0.0, rms_effort = 0.0;  // N or N m; 0: the run has none
  double motor_error = 0.0;                    // of the motor, of an elastic axis
  std::optional<double> dwell, dwell_area;     // of the load, peak to peak and over the master, in the longest rest
};

class Studio {
 public:
  // A studio with a motion that rests for a turn of its master.
  Studio();

  // ---- files ----
  // The motion file `text`, whose name in messages is `file`; the first of its cams is edited, or the one that the step
  // cam names. Throws machine::MachineFileError and leaves everything as it was.
  void load_motion(const std::string& file, const std::string& text);
  // The motion file as the commands write it.
  std::string motion_text() const;
  // Edits the cam `at` of the file. Throws sim::cam::CamError for none.
  void choose_cam(std::size_t at);
  // The machine file `text`, as `file`; an `axis` by name, or empty for the first that the slave fits. Throws
  // machine::MachineFileError and leaves the machine as it was.
  void load_machine(const std::string& file, const std::string& text, const std::string& axis = {});

  // The project of a step cam `text`, as `file`, for the open motion. Throws machine::MachineFileError and
  // sim::cam::CamError and leaves everything as it was.
  void load_step(const std::string& file, const std::string& text);
  // A project of usual dimensions for the motion, in one step.
  void new_step();
  // The project as the commands write it. Throws sim::cam::CamError without one.
  std::string step_text() const;

  // What the commands export of the motion: the drive's table, as `stiction cam table` writes it, for the `format`
  // "table"; else a file of that format as `stiction cam export` writes it without further options. Throws
  // sim::cam::CamError.
  std::string exported_file(std::string_view format) const;

  // ---- editing ----
  // One step of editing the segment `at`, after which undo() is possible. `verb`: "drag" (its end, to the master's
  // place `x` and the slave's position `y`), "level" (its end, to the position `y`), "law" (`key`), "value" (parameter
  // `key` to `x`), "default" (parameter `key`), "speed" (forced at its end to `x`), "free" (nothing forced there),
  // "split" (at the place `x`), "remove", "insert" (a rest of half of its length before it), "start" (`x`), "cycle"
  // (`x`), "modulo" (`x`, of an endless slave; 0: none), or one of the tracks' (track_edit.hpp). `goes_on`: the step
  // belongs to the one before, as those of one drag do. Throws sim::cam::CamError, machine::ValueError and
  // machine::MachineFileError, and leaves the motion as it was.
  struct Step {
    std::string_view verb;
    std::size_t at = 0;
    std::string_view key{};
    double x = 0.0, y = 0.0;
    bool goes_on = false;
  };
  void edit(const Step& step);
  // Replaces the motion, in one step, by what `method` of `stiction cam shape` makes of it at the `speed` of the master
  // with the usual band of 20 %. Throws sim::cam::CamError where it has no room or the motion or the axis has no dwell,
  // elastic shaft or machine.
  void shape(std::string_view method, double speed);
  // Changes the step cam's key `name` in one step, to a number in the page's unit, none leaving it out, or to a word;
  // or its relief. Throws as with_number(), with_choice() and StepStudio::relieved() do, and leaves it as it was.
  void set_step_number(std::string_view name, std::optional<double> value);
  void set_step_choice(std::string_view name, std::string_view value);
  void set_relief(const ReliefStep& step, bool goes_on);
  bool undo();  // whether there was a step to take back
  bool redo();

  // ---- what the page shows ----
  const sim::cam::Cam& cam() const { return motion_.cam; }
  // The step cam with the motion as it is now.
  const StepStudio& step() const;
  const sim::cam::Motion& motion() const { return motion_; }
  const machine::Machine* machine() const { return machine_ ? &*machine_ : nullptr; }
  // Segments, forced values, what can be undone, jumps, and, where there is a machine, its limits at the `speed` of the
  // master in its unit over s, as JSON.
  std::string state_json(double speed) const;
  // All laws with their parameters, as JSON.
  static std::string laws_json();
  // All methods against residual vibration, and all formats of other makers, as JSON.
  static std::string methods_json();
  static std::string formats_json();
  // The unit law number `k` of the table of laws at 41 places.
  static StudioTable law_curve(std::size_t k);
  // Master, position, its three derivatives over the master, y' y'' and the motor's effort at the `speed` of the
  // master (0 without a machine), with both sides of each joint. `points`: about how many rows.
  StudioTable curves(double speed, std::size_t points) const;
  // Amplitudes of `count` harmonics of the acceleration over a cycle, in the slave's unit over the master's square.
  std::vector<double> harmonics(std::size_t count) const;

  // The axis with the drive's cam, as `stiction simulate cam` runs it, at `speed` over `cycles` that are measured; the
  // record has all of them. Throws what run_cam() throws, and std::runtime_error without a machine.
  StudioRun follow(double speed, int cycles) const;
  // The axis with a master that turns from the beginning, as `stiction simulate cam --model cascade` runs it, at
  // `speed` over `cycles`; `stiffness`: of its shaft, as a share of the machine file's. Throws as run_stand() does.
  StudioRun stand(double speed, int cycles, double stiffness = 1.0) const;

 private:
  struct Version {
    std::vector<sim::cam::Cam> cams;
    sim::cam::Motion motion;
    std::size_t edited = 0;
    StepProjectPointer step{};
  };
  void begin_step(bool goes_on);
  Version version();
  void restore(Version version);
  void keep(sim::cam::Cam cam, bool goes_on);
  void keep_step(step::StepProject project, bool goes_on);
  const machine::Machine& required_machine() const;

  std::string motion_file_ = "motion.toml";
  std::vector<sim::cam::Cam> cams_;  // of the file
  std::size_t edited_ = 0;           // of them
  sim::cam::Motion motion_;
  StepProjectPointer step_project_;
  mutable StepStudio step_;
  std::vector<Version> past_, future_;
  std::optional<machine::Machine> machine_;  // with one axis
  AxisLoad load_;
};

}  // namespace stiction::host
