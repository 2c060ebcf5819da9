// What a diagnosis found: causes with parameters and evidence, what was tried and rejected, what stays unexplained. The
// report and verdict.json show it; they compute nothing. Everything is computed on the linear axis; parameters and
// words are in the units of the axis itself, and `units` shows the rest in them.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/effect.hpp"
#include "host/diagnose/record/noise_floor.hpp"
#include "host/diagnose/verdict/agreement.hpp"
#include "host/log/log.hpp"
#include "host/log/shown_units.hpp"
#include "sim/cam/motion.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/force_map/force_map.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// A key of an effect with what was found.
struct EffectParameter {
  std::string key;   // "pitch"
  std::string unit;  // SI, of the axis itself
  bool list = false;
  std::vector<double> values;           // one, or those of a list
  std::vector<double> standard_errors;  // one a value; empty: not known

  // In verdict.json: "pitch_m".
  std::string name() const { return key + sim::unit_suffix(unit); }
};
// Of an axis' effect. Throws std::logic_error for a key that the effect has not. `values` and `errors` in SI of the
// linear axis, one for each of a list.
EffectParameter effect_parameter(const machine::AxisModel& axis, sim::EffectId effect, std::string_view key,
                                 std::vector<double> values, std::vector<double> errors);

struct ConfusedWith {
  sim::EffectId effect;
  std::string separate_by;   // the experiment that tells them apart
  bool always = false;       // no motion of this axis alone does
  double probability = 0.0;  // by these records
};

// Ratios of the extended to the baseline simulation on data that was not used.
struct HoldoutGain {
  double force_rms_ratio = 1.0;
  std::optional<double> position_error_rms_ratio;  // none: no set-points to run in closed loop
  std::optional<double> command_rms_ratio;         // of a finding in the command residual
  std::optional<double> encoder_rms_ratio;         // of a finding in the difference of the encoders
  std::array<double, 2> ci95{1.0, 1.0};            // of force_rms_ratio, or of one of the last two where there is one
};

// Where a cause shows.
enum class Residual { force, command, encoders };
inline constexpr const char* residual_words(Residual residual) {
  return residual == Residual::force     ? "residual force"
         : residual == Residual::command ? "command residual"
                                         : "difference of the encoders";
}

// In how many of the searches, each with one log (of very many: one part of them) left out, a cause was named.
struct NamedIn {
  std::size_t named = 0, searches = 0;
};

struct Finding {
  explicit Finding(sim::EffectId found) : effect(found) {}

  sim::EffectId effect;
  std::string axis;
  machine::KeyedValues values;  // as they go into the extended machine file
  std::vector<EffectParameter> parameters;
  Residual residual = Residual::force;  // of which explains, p_value and holdout speak
  double explains = 0.0;                // share of the residual's variance that it takes away, given the other findings
  HoldoutGain holdout;
  double p_value = 1.0;
  double probability = 1.0;  // of this name, of all that could be in its place, one without a name included
  std::vector<ConfusedWith> confused_with;
  std::optional<NamedIn> without_each_log;  // none: of a single log
  std::string evidence;                     // sentences for readers
  std::optional<double> part_error;         // m, what it does to the part: peak change of the position error by it
  std::string withheld;                     // clause: why the extended machine file lacks its keys; empty: it has them
  std::vector<sim::Chart> charts;

  bool names_cause() const { return !sim::is_a<sim::ForceMap>(effect); }
  machine::Effect row() const { return sim::effect_with(effect, values); }  // of the extended machine file
};

inline std::size_t named_causes(const std::vector<Finding>& findings) {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(), [](const Finding& finding) { return finding.names_cause(); }));
}

// Those whose keys the extended machine file has.
inline std::vector<Finding> written_findings(std::vector<Finding> findings) {
  std::erase_if(findings, [](const Finding& finding) { return !finding.withheld.empty(); });
  return findings;
}

// The order in which they are told: causes before what has no name, and each by what it explains.
inline bool told_before(const Finding& one, const Finding& other) {
  return one.names_cause() != other.names_cause() ? one.names_cause() : one.explains > other.explains;
}

// The order in which a page tells them, as places in `findings`: causes before what has no name, and each by what it
// does to the position, then by what it explains.
inline std::vector<std::size_t> told_by_position(const std::vector<Finding>& findings) {
  std::vector<std::size_t> order(findings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t one, std::size_t other) {
    const Finding &a = findings[one], &b = findings[other];
    if (a.names_cause() != b.names_cause()) return a.names_cause();
    const double of_a = a.part_error.value_or(0.0), of_b = b.part_error.value_or(0.0);
    return of_a != of_b ? of_a > of_b : a.explains > b.explains;
  });
  return order;
}

// Of the residual in which it shows, on held-out data: with it over without it, rms.
inline double gained_ratio(const Finding& finding) {
  const auto& holdout = finding.holdout;
  return holdout.encoder_rms_ratio.value_or(holdout.command_rms_ratio.value_or(holdout.force_rms_ratio));
}

struct Rejected {
  sim::EffectId effect;
  std::string why;
};

// A parameter of the axis that is not the same in the training and in the held-out records: another workpiece, another
// day. In SI, of the axis itself.
struct ChangedParameter {
  sim::EffectId effect;  // by which the machine file would have it
  std::string key, unit;
  double training = 0.0, held_out = 0.0;
  double standard_error = 0.0;  // of their difference
};

// What is left over, by what it looks like.
struct Unexplained {
  double share = 0.0;                    // of the baseline's residual variance that is neither explained nor noise
  std::optional<std::string> signature;  // none: nothing that repeats
};

// What the records leave open: which of two causes it is, or whether it is there at all.
struct OpenQuestion {
  sim::EffectId effect;
  std::optional<sim::EffectId> rival;  // none: whether the effect is there
  std::string separate_by;             // the experiment in words
  bool by_motion = true;               // false: no motion of this axis alone answers it
  double these_logs = 0.0;  // standard errors between the two answers that these records were to be expected to give
};

// Standard errors: what a trajectory separates by less it leaves open, even recorded four times.
inline constexpr double least_separation = 2.5;

// Of what a cause does in all records, squared: so much a different name must be unable to imitate before it is
// excluded, however certain that is. A search knows the forces no better (of_strongest in
// host/diagnose/search/price.hpp).
inline constexpr double least_share = 0.02;

struct RehearsedTrajectory {
  std::string name, words;
  double duration = 0.0;            // s
  std::vector<double> separations;  // standard errors expected of it, one a question; 0 where no motion answers
  // Of a cam, one a question: the part, of what a cause does in these records and in this one together, that the other
  // cannot imitate, squared. Empty of paths of set-points.
  std::vector<double> shares{};

  // Whether it is expected to answer the question of that index, recorded as often as it must be.
  bool answers(std::size_t question) const {
    return separations[question] >= least_separation && (shares.empty() || shares[question] >= least_share);
  }
};

// The cam of a measurement of an axis that follows a master.
struct ProposedCam {
  sim::cam::Cam cam;            // in the axis' own unit over an angle of the master
  double rise = 0.0;            // rad of the master
  std::string law;              // of its rises
  double turns = 0.0;           // of the master in a minute
  std::string speed;            // the same, as `simulate cam --speed` takes it
  double master_speed = 0.0;    // rad/s
  double recorded_speed = 0.0;  // rad/s, the highest of the master in the present records
  int cycles = 0;               // that are recorded
  std::string spectrum{};       // sentences: at which orders of the master lift and candidates have their lines
};

// What to record next, chosen by running each trajectory in simulation.
struct NextMeasurement {
  std::string axis;
  std::vector<OpenQuestion> questions;
  std::vector<RehearsedTrajectory> trajectories;  // the best first
  // Of the best one: set-points, and x and i as the machine file's simulation gives them. None: no trajectory answers
  // any of the questions.
  std::optional<Log> log;
  int times = 1;     // how often it must be recorded until the question that it answers worst is settled
  std::string note;  // where it begins, how far it goes
  std::vector<sim::Chart> charts;
  std::optional<ProposedCam> cam{};  // of the best one, of an axis that follows a cam
};

struct ResidualFigures {
  double force_rms = 0.0;                    // N
  std::optional<double> position_error_rms;  // m, measured against simulated; none without set-points
  std::optional<double> command_rms;         // A, or V of a force source, above 1 Hz; none without set-points
};

// A measured row of the machine file beside the simulation: largest error (m) and largest current (A) of a circle.
struct RowFigures {
  double error = 0.0;
  double current = 0.0;
};
struct RowShare {
  sim::EffectId effect;
  RowFigures by;  // what the extended simulation loses without it
};
struct DiagnosedRow {
  std::string axis;
  double feed = 0.0;  // m/s
  bool training = false;
  RowFigures measured, machine_file, extended;
  std::optional<RowFigures> published;  // with the friction model in use
  RowFigures left_out;                  // extended, had this feed alone been left out of the training
  std::vector<RowShare> shares;
};
// Mean |simulated / measured - 1| over rows.
struct RowScore {
  double error = 0.0, current = 0.0;
};
struct RowScores {
  RowScore published, machine_file, extended;  // published: of rows that have it
};
struct ReferenceRows {
  std::string reference;  // "circle"
  std::string friction;   // the model in use
  std::vector<DiagnosedRow> rows;
  RowScores unused;    // rows of feeds that took no part
  RowScores left_out;  // all rows, each predicted with its feed left out of the training
};

// What identification from the training logs put into the machine file before it was diagnosed.
struct StartValue {
  std::string name;  // with its unit: "mass_kg"
  double value = 0.0;
  std::array<double, 2> ci95{};
};

struct Verdict {
  std::string axis;  // of the machine; empty of a diagnosis of rows
  ShownUnits units;  // of the axis; figures and charts are in those of the linear axis until they are shown
  std::string machine;
  std::vector<std::string> logs, holdout;
  bool holdout_is_a_part = false;      // no held-out log was given: the last third of each log stands in for one
  ResidualFigures baseline, extended;  // on the held-out data
  std::string closed_loop_withheld;    // why they have no position error although there are set-points; empty: they do
  std::string command_unit = "A";      // of their command_rms
  // Of the held-out data: what noise alone leaves, and whether the extended machine file (of no findings: the file)
  // leaves no more. None of a diagnosis of rows, whose noise is not known.
  std::optional<NoiseFloor> noise_floor;
  std::optional<Agreement> agreement;
  std::vector<Finding> findings;  // by what each explains, the largest first
  // m: a cause that changes the position error by less is small. None: no closed loop.
  std::optional<double> small_below;
  std::size_t exact_records = 0;  // of the machine as its file says, in which the names were looked for too
  std::vector<Rejected> rejected;
  std::vector<ChangedParameter> changed;  // between training and held-out records; the force is judged without it
  Unexplained unexplained;
  std::vector<std::string> questions;      // on amperes, lengths, signs and shifts of the logs: to be answered first
  std::vector<StartValue> identified;      // empty: the file was diagnosed as it is
  std::vector<std::string> notes;          // on the data: suspicions, what to record next
  std::optional<NextMeasurement> next;     // none: nothing is open
  std::optional<ReferenceRows> reference;  // of a diagnosis of the machine file's own rows
  std::vector<sim::Chart> before_after;  // measured against simulated, before and after; residual by position, speed..

  bool is_small(const Finding& finding) const {
    return small_below && finding.part_error && *finding.part_error < *small_below;
  }
};

}  // namespace stiction::host
