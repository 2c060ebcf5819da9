// Identification of one axis from its logs or from a table of steady states: parameters with intervals, how each was
// found, and what the data could not determine.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "host/identify/band.hpp"
#include "host/identify/friction_fit.hpp"
#include "host/identify/initial_values.hpp"
#include "host/identify/sliding_curve.hpp"
#include "host/identify/steady_table.hpp"
#include "host/log/questions.hpp"

namespace stiction::host {

struct IdentifiedParameter {
  std::string name;  // with its unit: "mass_kg"
  double value = 0.0;
  Interval ci95{};
  std::string how;  // a clause for readers
};

struct NotDetermined {
  std::string name;
  std::string why;
  std::string record;  // what to record instead
};

// What is left of the force in one log.
struct LogResidual {
  std::string source;
  std::vector<double> time, speed, residual;  // s, m/s, N
};

// Force that a fit leaves on blocks that took no part in it.
struct HeldOutForce {
  double fit = 0.0;    // N rms
  double plain = 0.0;  // N rms, of a least squares of mass, viscous friction, Coulomb friction and offset, same rows
};

struct Identification {
  std::string axis;
  bool rotary = false;  // in rad, rad/s, N m, kg m^2 (own_identification.hpp)
  std::vector<std::string> sources;
  std::string friction;  // the law that was fitted, by its name in a machine file
  std::string method;    // sentences for readers
  std::size_t samples = 0;
  std::vector<IdentifiedParameter> parameters;
  std::vector<NotDetermined> not_determined;
  InitialValues initial;
  std::optional<SlidingCurve> curve;  // none where the axis hardly slides
  std::vector<SlipElement> elements;  // Maxwell slip; empty when the presliding was not determined
  double force_rms = 0.0;             // N
  std::optional<Band> band;           // none: the fixed band of a published recipe, or a table
  std::optional<HeldOutForce> held_out;
  std::vector<Question> questions;  // to be answered before the result is believed, of each kind one
  std::vector<std::string> notes;   // sentences on what of the logs did not count
  double residual_rms = 0.0;        // N
  std::vector<LogResidual> residuals;

  const IdentifiedParameter* find(std::string_view name) const;
};

struct IdentifyOptions {
  // The law to identify by its name in a machine file: "coulomb_viscous" means the published recipe; the axis' law in
  // use its own contact, where that has one length; all else LuGre's contact.
  std::string friction;
  Amperes amperes = Amperes::amplitude;
  FitSettings fit;
  // The band follows the data, and samples at standstill, where the friction of a law that sticks is a reaction, do not
  // count. Without it "coulomb_viscous" is the published recipe.
  bool moving_rows_only = false;
  Held held{};  // values that are given, not estimated: mass, viscous friction, constant force, Coulomb friction
};

// The log's channels of that axis, or those without an axis' name. Throws LogError when it has neither.
const AxisLog& channels_of(const Log& log, const machine::AxisModel& axis);
AxisLog& channels_of(Log& log, const machine::AxisModel& axis);

// `axis`: of the machine that the logs belong to; each log's channels of that axis, or those without an axis' name.
// Throws LogError for logs that cannot be used (suitability.hpp). `options`: friction model, amperes, bootstrap.
Identification identify_logs(const std::vector<Log>& logs, const machine::AxisModel& axis,
                             const IdentifyOptions& options);

// The same from a table. `table`: rows of steady motion; `axis`: of the machine; `stated`: convention of the currents
// where the table has none; `settings`: of the bootstrap. Throws LogError.
Identification identify_table(const SteadyTable& table, const machine::AxisModel& axis, std::optional<Amperes> stated,
                              const FitSettings& settings);

}  // namespace stiction::host
