// What the engine knows of one effect: the regressors by which it shows in the residual force, the nonlinear parameters
// to scan, and what fitted weights mean in a machine file's keys. One in the folder of each effect
// (effect_regressor.hpp), one in signatures/ for each shape outside of the vocabulary.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/classes/exact_record.hpp"
#include "host/diagnose/spectrum/line_scan.hpp"
#include "host/diagnose/spectrum/place_scan.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"
#include "host/identify/motion.hpp"
#include "sim/effects/effect_descriptor.hpp"

namespace stiction::host {

// What a search has found so far of lines: over position, over position in proportion to the force and to the speed,
// over time, over the encoder's signal; and of places of friction, and of a force.
struct Scans {
  LineScan pitches{}, modulation{}, by_speed{}, times{}, signals_of_encoder{};
  PlaceScan tight_spots{}, pushes{};
};

// How records follow one another; empty (`end` is 0) where that is not known.
struct Session {
  std::map<std::string, double, std::less<>> begins;  // s, from the first one's, of records by their source
  double end = 0.0;                                   // s, of the last training record

  // s; the end for a record that is not known.
  double begin_of(std::string_view source) const {
    const auto found = begins.find(source);
    return found == begins.end() ? end : found->second;
  }
};

// What the candidates may know: the axis as its file has it and what the training records cover. SI units.
struct SearchContext : Scans {
  machine::AxisModel axis;
  SignalSettings signals;
  double highest_speed = 0.0;
  int reversals = 0;
  double lowest_position = 0.0, highest_position = 0.0;
  double highest_force = 0.0;     // N, expected
  double resolved_force = 0.0;    // N rms, by which the inverse dynamics may be off
  double highest_residual = 0.0;  // N, what the file does not make of the force
  bool force_is_current = false;  // in every record: current (or voltage) times the file's force constant
  bool other_axis = false;        // its motion is in every record
  double duration = 0.0;          // s, of the longest record
  Session session{};
  double log_period = 0.0;  // s, of the slowest record
  // Whether what disturbs the axis is in the motion of the regressors: where that is measured, or learned from it.
  bool disturbed_motion = false;
  bool measured_motion = false;  // the loop's answer too, as late as it comes
  machine::Timing timing{};      // of the drive
  // The residual force (N, at the motion's rate) that a motion's set-points leave in simulation where the machine has
  // the effect, less that where it has not: what the effect does through the control loop. `most_runs`: of how many
  // runs under different forces the common part is taken, at most. Empty: no set-points.
  std::function<std::vector<double>(const Motion&, const machine::Effect&, std::size_t most_runs)> response;
  // From now on under forces like this one (N, of the rows): what of the residual force no cause explains.
  std::function<void(const Eigen::VectorXd&)> disturb;
  // Of exact machines under forces like this one (N, of the rows): exact_records.hpp. Empty: no simulation.
  std::function<ExactRecords(const Eigen::VectorXd&)> exact_records;
  // Of each candidate, nats: what it has to pay beside all others, and what it has to be worth beyond that before it is
  // called a cause (calibration.hpp). Empty: nothing.
  std::vector<double> prices, hurdles;
  double stroke() const { return highest_position - lowest_position; }
};

// Columns of the residual force at a motion's full rate (N per unit of weight): the motor's force is larger by column
// times weight where the machine has the effect.
using Columns = std::vector<std::vector<double>>;

struct Candidate {
  // Values of the nonlinear parameter to try; one value, not looked at, for an effect that has none. Empty: this axis
  // or these records cannot have the effect.
  std::vector<double> (*grid)(const SearchContext&) = nullptr;
  Columns (*columns)(const SearchContext&, const Motion&, double shape) = nullptr;
  // Whether weights have a sign and size that the effect can have.
  bool (*possible)(const SearchContext&, double shape, const Eigen::VectorXd& coefficients);
  // Keys of the machine file; `deviations`: of weights and nonlinear parameter (last), covariance. Of a force outside
  // of the vocabulary: those of a force_map; null where no table holds it.
  void (*describe)(const SearchContext&, double shape, const Eigen::VectorXd& coefficients,
                   const Eigen::MatrixXd& covariance, Finding&) = nullptr;
  // The same with more keys, for where runs of the machine fit the better with them; null: there are none.
  void (*describe_freely)(const SearchContext&, double shape, const Eigen::VectorXd& coefficients,
                          const Eigen::MatrixXd& covariance, Finding&) = nullptr;
  // Values (of the effect's keys) near the given ones from which runs may begin, where columns tell them roughly; null:
  // they tell them well.
  std::vector<machine::KeyedValues> (*starts)(const machine::KeyedValues&) = nullptr;
  bool shape = false;  // whether the scanned parameter is one of the effect's own
  // It goes with acceleration as the inverse dynamics' own errors do: what is no larger than those is none
  // (resolution_of_dynamics).
  bool like_dynamics = false;
  bool at_weight = false;       // the scanned value is where the law is linearised: at best the weight itself
  bool names_constant = false;  // what it names is not a nuisance of its own evaluation
  bool names_coulomb = false;
  bool of_state = false;      // a workpiece or a day changes it (changed_between.hpp)
  bool along_stroke = false;  // known between the places that the records reach, and nowhere else
  bool periodic = false;      // pairs cosine, sine by harmonics: the phase moves with the home position
  // Whether each record has weights of its own, the first record's before the second's: the phase moves from record to
  // record.
  bool per_record = false;
  // The lines among which a periodic one is looked for; null for others.
  const LineScan& (*scan)(const SearchContext&) = nullptr;
  bool of_reading = false;       // it goes with what the encoder read, which the loop's answer to every force is in
  bool through_session = false;  // its clock goes on through all records, which that of no run does
  bool replays = false;          // its columns cost a run of the closed loop
  // Whether it matters little at a value what disturbs those runs; null: at none.
  bool (*coarse)(const SearchContext&, double shape) = nullptr;
  double trials = 1.0;      // independent values that a grid without a scan tries
  bool two_bodies = false;  // it makes two of the axis, which the plant does once
  // The places among which a local one is looked for, beside the grid (PlaceScan::value_of); null for others.
  const PlaceScan& (*places)(const SearchContext&) = nullptr;
  // Of a force outside of the vocabulary: what it looks like. It takes part in the search so that no name is forced
  // upon what none fits; found, it is no finding but the signature of what stays unexplained. Null for an effect.
  std::string (*looks_like)(const SearchContext&, double shape, const Eigen::VectorXd& coefficients) = nullptr;
  // By whose folder it is; set by candidates(). None: a shape outside of the vocabulary.
  std::optional<sim::EffectId> effect{};
  bool outside() const { return !effect; }
  bool has_map() const { return outside() && describe != nullptr; }
};

// The vocabulary in its order; behind it what is outside of it.
std::span<const Candidate> candidates();
// Whether the candidates at the places `a` and `b` there are of one name: two arrangements of one effect.
bool one_cause(std::size_t a, std::size_t b);
// The first place of the effect there; none where it does not show in the residual force.
std::optional<std::size_t> candidate_index(sim::EffectId effect);

namespace effects {
// Adds a key of the finding's effect with its values and their standard errors. Throws std::logic_error for a key that
// the effect has not. `context`: of the axis, which has the unit of `key`; `finding`: to which it is added; `values`
// and `errors` in SI.
void add_key(const SearchContext& context, Finding& finding, std::string_view key, std::vector<double> values,
             std::vector<double> errors);

// Cosine and sine of a wave over position, as force on the carriage of `size` (of each sample) times it. `motion` of
// the axis; `pitch` in m.
Columns waves_over_position(const Motion& motion, double pitch, const std::vector<double>& size);

// Adds the keys of a wave over position whose length (m) is the scanned `shape`: that one by its name `length`, and the
// amplitudes "cosine" and "sine". `context`, `finding`: as above; `w` and `c`: coefficients and covariance, the
// length's last.
void add_wave_keys(const SearchContext& context, Finding& finding, std::string_view length, double shape,
                   const Eigen::VectorXd& w, const Eigen::MatrixXd& c);

inline std::vector<double> no_scan(const SearchContext&) { return {0.0}; }
// For an effect whose coefficients (VectorXd) may have any sign and size, at each shape (double) and SearchContext.
inline bool any(const SearchContext&, double, const Eigen::VectorXd&) { return true; }
// Of the weights of a wave that has a pair in each record: the amplitude that they have in common (their root mean
// square) with the first record's phase, as cosine and sine.
std::array<double, 2> first_wave(const Eigen::VectorXd& coefficients);
// `count` values from `low` to `high`, each the same factor above the one before.
std::vector<double> geometric(double low, double high, int count);
}  // namespace effects

// Shapes of forces that no effect of the vocabulary has; each source has a namespace of its own.
namespace signatures {
namespace localised_force {
extern const Candidate shape;
}
namespace ripple_with_speed {
extern const Candidate shape;
}
namespace force_after_reversal {
extern const Candidate shape, shape_on_way_back;
}
namespace force_with_acceleration {
extern const Candidate shape;
}
namespace drifting_force {
extern const Candidate shape;
}
namespace smooth_functions {
std::span<const Candidate> all();
}
}  // namespace signatures

}  // namespace stiction::host
