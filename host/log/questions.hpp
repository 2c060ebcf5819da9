// Questions to ask before any result: amperes that look like rms, a length in another unit, a swapped sign, channels
// that are late. Each is a hypothesis on the record that is compared, by its likelihood, with the one that all is
// sound.
//
// The force of the recorded effort over the record's accelerations is a mass; over the mass of the machine file it is
// the ratio r, 1 where all is sound. The file's mass is taken as known within 15 % (uniform in its logarithm), r within
// its jackknife error. A hypothesis says a factor of r: 1/sqrt 2 and sqrt 2 (rms), 1e-3 and 1e3 (mm for m, m for mm),
// of a rotary axis pi/180 and 180/pi (degrees), -1 (sign); one says nothing but that something else is wrong. A
// question is asked where its probability is above that of a sound record, with the prior probabilities of
// questions.cpp. The same hypotheses are compared on channels that should be one: x and x_set, v and the speed of x, i
// and i_set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/log/known_axis.hpp"
#include "host/log/log.hpp"
#include "host/log/rigid_motion.hpp"

namespace stiction::host {

struct Question {
  enum class About { amperes, length, angle, sign, shift, scale } about = About::scale;
  std::string text;              // the question in a sentence, with its figures and what to do
  double value = 0.0;            // ratio; of a shift s
  double low = 0.0, high = 0.0;  // of its 95 % interval
  double probability = 0.0;      // of its hypothesis
};

// Empty where the record is sound, or tells too little. `log`: even; `axis`: of it; `known`: what the machine file says
// of the axis; without mass and force constant the ratios of channels, signs and shifts are asked still.
std::vector<Question> questions_of(const Log& log, const AxisLog& axis, const KnownAxis& known = {});

// What the record gives only as a ratio, in a sentence: the mass over the force constant where neither is checked by
// another channel. Empty: the effort is a force, or the motion gives no mass. `log`, `axis`: as above.
std::string known_only_as_ratio(const Log& log, const AxisLog& axis);

}  // namespace stiction::host
