// An impact test as the simulation might leave it, for tests of its report: deviations and forces of four friction
// models that follow the published description, figures with and without expectations, and no plant.
#pragma once

#include "host/report/experiment_report.hpp"

namespace stiction::host {

// One figure differs from its expectation: the peak deviation with the parabolic model.
ExperimentReport synthetic_experiment();

// Charts that an impact test does not have: a loop, a logarithmic abscissa with measured points, a variant of a model
// and names that are not models; no control, no expectations.
ExperimentReport synthetic_friction_bench();

}  // namespace stiction::host
