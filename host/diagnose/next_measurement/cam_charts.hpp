// A proposed cam as it is shown: the lift, and its spectrum in orders of the master against those of the candidates.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/next_measurement/cam_rehearsal.hpp"

namespace stiction::host {

// What one of the causes in question does in a rehearsal.
struct CandidateForce {
  std::string title;      // of the effect
  Eigen::VectorXd force;  // N, one a row
};

// What the spectrum of a proposal is made of.
struct CamSpectrum {
  std::vector<CandidateForce> candidates;
  Eigen::VectorXd separating;  // whitened, one a row: what of the one the other cannot imitate
};

struct CamPicture {
  std::vector<sim::Chart> charts;
  std::string words;  // what the spectrum shows, in sentences
};

// Of a `rehearsal` that has a cam, of an `axis`, in its `units`. `spectrum`: of the rows of the rehearsal.
CamPicture cam_picture(const Rehearsal& rehearsal, const CamSpectrum& spectrum, const machine::AxisModel& axis,
                       const ShownUnits& units);

}  // namespace stiction::host
