// What the drive does with the records of its dwells (cam_tuning.hpp): it changes two pulses until nothing is left,
// watches the quality number in production, and starts again where it has grown. Beside the loop; whoever has the
// loop's records and puts the tables to it calls this (tuned_axis.hpp).
//
// A machine that runs on and on vibrates in each dwell by what the rise leaves and by what is left of the cycle before:
// only the first is the pulses' to cancel. It is known from two cycles that follow each other.
//
// Bounded probing: a start tries a number of tables at most, each with pulses below an amplitude. Where one was worse,
// the next goes from the best with what was learned of the drive; two in a row end it. The last better one is kept, and
// where the quality number itself is worse in the end, the pulses from before the start.
#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <optional>

#include "firmware/machine/configuration/cam_tuning_configuration.hpp"
#include "firmware/stictiond/tuned_table.hpp"

namespace stiction::drive {

enum class CamTuningState : std::uint8_t {
  off,       // not configured
  idle,      // records, and changes nothing
  tuning,    // tries pulses
  settling,  // waits until what was left of earlier cycles is gone, and compares
  watching   // compares the quality number with its limit
};

enum class CamTuningCommand : std::uint8_t {
  none,
  start,    // tunes, from the pulses that there are
  watch,    // compares with the limit from now on
  stop,     // tries and watches no more; the best pulses are kept
  restore,  // the table without pulses
};
inline constexpr int cam_tuning_commands = 5;

class CamTuner {
 public:
  struct Config {
    machine::CamTuningDesign::Given given{};
    double amplitude = 0.0;      // the most of a pulse, in the unit of the table
    double quality_limit = 0.0;  // 0: none
    int steps = 6;
    int pause = 50;
    bool by_itself = false;
  };

  // Throws machine::CamTuningError.
  explicit CamTuner(const Config& config);

  // A record of the loop, with the configuration that it was made with.
  struct Record {
    const CamTuning::Config* config = nullptr;
    const CamTuning::State* state = nullptr;
    std::int64_t cycle = 0;    // of the master
    double time = 0.0;         // s, of the end of its rise
    PulseAmplitudes pulses{};  // of the table that was followed
    bool as_its_table = true;  // neither scaled nor shifted
  };

  void command(CamTuningCommand command);
  // Takes a `record`; what pulses() says may be different afterwards.
  void learn(const Record& record);
  // The table of pulses() cannot be taken, for that `reason`: those of the best are wanted again.
  void reject(CamTuningRefusal reason);

  // The pulses that are wanted.
  const PulseAmplitudes& pulses() const { return wanted_; }
  // For the records to come.
  CamTuning::Config config() const { return design_->config(factor_); }
  const machine::CamTuningDesign& design() const { return *design_; }

  CamTuningState state() const { return state_; }
  CamTuningRefusal refusal() const { return refusal_; }  // of the last record, or how the last start ended
  double quality() const { return quality_; }            // of the last record, in the unit of the table times cycles
  double quality_before() const { return before_; }      // when the last start began
  double frequency() const { return config_.given.mode.frequency; }
  int steps() const { return steps_; }  // of the last start
  int grown() const { return grown_; }  // how often the quality number came above the limit
  static constexpr int most_over = 3;   // cycles in a row

 private:
  struct Seen {
    std::int64_t cycle = 0;
    double time = 0.0;
    std::complex<double> vibration;
  };
  struct Tried {
    PulseAmplitudes pulses{};
    std::complex<double> own;
  };

  void begin(CamTuningState after);
  void end(CamTuningRefusal reason);
  std::optional<std::complex<double>> own_part(const Record& record, std::complex<double> vibration) const;
  bool identify(const Record& record);
  void tune(std::complex<double> own);
  void scale_by_model(std::complex<double> own);
  void learn_drive(const Tried& before, const Tried& now);
  void try_from(const Tried& tried);
  void compare(std::complex<double> own);
  void watch();

  Config config_;
  std::unique_ptr<machine::CamTuningDesign> design_;
  std::complex<double> factor_ = 1.0;  // of the model's vibrations over those of the records
  CamTuningState state_ = CamTuningState::idle, after_ = CamTuningState::idle;
  CamTuningRefusal refusal_ = CamTuningRefusal::none, outcome_ = CamTuningRefusal::none;
  PulseAmplitudes wanted_{}, at_start_{};
  std::optional<Tried> best_;
  std::optional<Seen> last_;
  double quality_ = 0.0, before_ = 0.0;
  int steps_ = 0, worse_ = 0, identified_ = 0, over_ = 0, grown_ = 0, refused_ = 0, settle_ = 0;
  std::int64_t cycles_ = 0, next_start_ = 0;  // records, and from which on it may start by itself
  bool first_ = false;
};

}  // namespace stiction::drive
