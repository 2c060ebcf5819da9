// A column's header, "X.x_set[mm]": axis, name, unit. Every format of a log has the same names
// (docs/formats.md).
#pragma once

#include <string>
#include <string_view>

#include "host/log/log.hpp"

namespace stiction::host {

struct ChannelName {
  std::string_view axis;  // empty without prefix
  std::string_view name;
  std::string_view unit;  // empty without brackets
};

// Any text has a name in this sense; an axis is a word of letters, digits, '_' and '-' before the last point.
ChannelName split_channel_name(std::string_view header);

// Null for a name that is no channel of an axis. "t" is none.
const LogChannel* find_channel(std::string_view name);

// "X.x[m]", or "x[m]" without an axis.
std::string channel_header(std::string_view axis, const LogChannel& channel);

// The axis of that name, appended when it is new.
AxisLog& axis_of(Log& log, std::string_view axis);

// What every format requires of a log with its columns read: at least one axis, the measured position and a current, a
// force or a voltage for each, and prefixes for all axes or none. Throws LogError, "PLACE: found ...; expected ...".
void require_channels(const Log& log, std::string_view place);

}  // namespace stiction::host
