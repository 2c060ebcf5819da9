// What the simulation of a machine file gets wrong against the file's own measured rows (largest error and largest
// current of a circle, feed by feed), named, extended, and scored on the feeds that took no part. Two numbers a row do
// not tell twelve causes apart: the sliding law comes from the rows of steady friction, the shape of the contact from
// those of presliding, one scale each from the row of one training feed; everything else is said not to be told.
#pragma once

#include <functional>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// Throws MissingRows for a machine whose rows do not allow it, sim errors for one that cannot drive them. The training
// feed is that of docs/friction_model.md, at which the published simulation was matched to the machine too.
Verdict diagnose_reference(const machine::Machine& machine, const std::function<void()>& progress = {});

}  // namespace stiction::host
