// Records made ready for a diagnosis: checked, cut into training and held-out data, with the residual force that the
// file leaves in them, the motion that columns are made of, and the simulation of the same axis to try causes in.
#pragma once

#include <memory>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/record/diagnose_input.hpp"
#include "host/diagnose/record/effect_response.hpp"
#include "host/diagnose/record/force_on_axis.hpp"
#include "host/diagnose/record/record.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

struct Prepared {
  machine::AxisModel axis;
  SignalSettings settings;
  Record training, held_out;
  ForceOnAxis on_axis;        // what of a residual force of the training records acted on the axis
  bool known_motion = false;  // whether regressors are of simulated motion
  SearchContext context;      // its `disturb` changes this context
  // Of all records, where they can be simulated: as they hunt, and smoothed.
  std::vector<EffectResponse> responses;

  Prepared() = default;
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;
};

// In rows of the `band`. Notes and questions go to the `verdict`. Throws LogError for logs of the `input` that cannot
// be used (record_checks.hpp, suitability.hpp).
std::unique_ptr<Prepared> prepare(const DiagnoseInput& input, RowBand band, Verdict& verdict);

}  // namespace stiction::host
