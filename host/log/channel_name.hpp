// A column's header, "X.x_set[mm]": axis, name, unit. Every format of a log has the same names
// (docs/formats.md).
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "host/log/log.hpp"
#include "host/log/unit_scale.hpp"

namespace stiction::host {

struct ChannelName {
  std::string_view axis;  // empty without prefix
  std::string_view name;
  std::string_view unit;  // empty without brackets
};

// Any text has a name in this sense; an axis is a word of letters, digits, '_' and '-' before the last point.
ChannelName split_channel_name(std::string_view header);

// Null for a name that is no channel of an axis, linear or rotary. "t" is none.
const LogChannel* find_channel(std::string_view name);

// What a column says of its axis by its name and unit: x[mm] and F[N] are linear, x[deg] and T[N m] rotary, i[A] both.
enum class AxisKind { either, linear, rotary };

// From a column's unit to that of the values, and the kind of axis that has such a column.
struct ChannelScale {
  UnitScale scale;
  AxisKind kind = AxisKind::either;
};

// `channel`: of the column; `name`: as the column calls it ("T" and "F" are one channel); `unit`: of the column, not
// empty except for whole numbers. Throws machine::UnitError for a unit of neither a linear nor a rotary axis.
ChannelScale channel_scale(const LogChannel& channel, std::string_view name, std::string_view unit);

// The name and the unit of a channel of this axis: F and N, or T and N m where it is rotary. `channel`: any that the
// axis has.
const char* name_on(const AxisLog& axis, const LogChannel& channel);
const char* unit_on(const AxisLog& axis, const LogChannel& channel);

// "X.x[m]", or "x[m]" without an axis; "T[N m]" of a rotary one.
std::string channel_header(const AxisLog& axis, const LogChannel& channel);

// The column of the phase of an endless axis, which is written and is no channel: "R.phase[deg]", or in mm of a linear
// one; and its value in a sample.
inline constexpr const char* phase_name = "phase";
const char* phase_unit(const AxisLog& axis);
std::string phase_header(const AxisLog& axis);
double shown_phase(const AxisLog& axis, std::size_t sample);

// What was found of each axis' kind while its columns were read.
class AxisKinds {
 public:
  // `axis`: of the column; `kind`: what it says; `header`: the column for the message; `place`: "FILE:LINE". Throws
  // LogError where the axis had a column of the other kind.
  void add(std::string_view axis, AxisKind kind, std::string_view header, std::string_view place);
  void mark(Log& log) const;  // sets AxisLog::rotary

 private:
  struct Found {
    AxisKind kind;
    std::string header;
  };
  std::map<std::string, Found, std::less<>> found_;
};

// Gives channels without prefix that belong to all axes (LogChannel::shared) to each axis that has none of its own,
// where the other channels have prefixes. `log`: with all its columns.
void share_channels(Log& log);

// Takes away channels that are blank in every sample and lists them as ignored. `log`: with all its columns.
void drop_blank_channels(Log& log);

// The axis of that name, appended when it is new.
AxisLog& axis_of(Log& log, std::string_view axis);

// What every format requires of a log with its columns read: at least one axis, the measured position and a current, a
// force (torque) or a voltage for each, and prefixes for all axes or none. Throws LogError, "PLACE: found ...; expected
// ...".
void require_channels(const Log& log, std::string_view place);

}  // namespace stiction::host
