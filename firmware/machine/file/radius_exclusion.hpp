// Why the drive's number formats hold a rotary axis on no radius, in the words of its file.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "firmware/machine/configuration/radius.hpp"
#include "firmware/machine/file/document.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// "axis.A: found max_velocity, "10 rad/s" (line 10), which ..., together with ...; expected ...": the keys of a
// `choice` that has no radius, with their values and lines in `table` at `path` of `document`. `axis`: as it was read.
std::string describe_exclusion(const Document& document, const toml::table& table, const std::string& path,
                               const AxisModel& axis, const RadiusChoice& choice);

}  // namespace stiction::machine
