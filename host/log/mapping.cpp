#include "host/log/mapping.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "firmware/machine/file/document.hpp"
#include "host/log/channel_name.hpp"
#include "host/log/message.hpp"
#include "host/log/text_file.hpp"
#include "host/log/unit_scale.hpp"

namespace stiction::host {
namespace {

constexpr std::string_view schema = "stiction.mapping/1";

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file)
      : name_(file.string()), document_(name_, read_text_file(file, "a mapping file")) {}

  Mapping read() {
    const auto& root = document_.root();
    allow(root, "", {"schema", "channel", "table", "time"});
    if (text(root, "schema") != schema)
      document_.fail(root.source(), "schema", describe(root, "schema"), fmt::format("\"{}\"", schema));
    mapping_.source = name_;
    mapping_.has_table_keys = root.contains("table") || root.contains("time");
    if (const auto* table = root.get("table")) read_table(as_table(*table, "table"));
    if (const auto* time = root.get("time")) read_time(as_table(*time, "time"));
    const auto* channels = root.get("channel") == nullptr ? nullptr : root.get("channel")->as_array();
    if (channels == nullptr || channels->empty())
      document_.fail(root.source(), "channel", describe(root, "channel"), "[[channel]] with from and to");
    for (const auto& channel : *channels) read_channel(as_table(channel, "channel"));
    return std::move(mapping_);
  }

 private:
  void allow(const toml::table& table, std::string_view path, const std::vector<std::string_view>& known) const {
    for (auto&& [key, value] : table)
      if (std::ranges::find(known, key.str()) == known.end())
        document_.fail_unknown(key.source(), machine::join_key(path, key.str()), known);
  }
  const toml::table& as_table(const toml::node& node, std::string_view key) const {
    if (!node.is_table()) document_.fail(node.source(), key, machine::describe_node(node), "a table");
    return *node.as_table();
  }
  static std::string describe(const toml::table& table, std::string_view key) {
    const auto* node = table.get(key);
    return node == nullptr ? "no such key" : machine::describe_node(*node);
  }
  const toml::source_region& place(const toml::table& table, std::string_view key) const {
    const auto* node = table.get(key);
    return node == nullptr ? table.source() : node->source();
  }
  // Empty where the key is not there.
  std::string text(const toml::table& table, std::string_view key) const {
    const auto* node = table.get(key);
    if (node == nullptr) return {};
    if (!node->is_string()) document_.fail(node->source(), key, machine::describe_node(*node), "a text");
    return node->as_string()->get();
  }
  [[noreturn]] void fail(const toml::table& table, std::string_view key, std::string_view expected) const {
    document_.fail(place(table, key), key, describe(table, key), expected);
  }

  void read_table(const toml::table& table) {
    allow(table, "table", {"separator", "decimal", "header_line"});
    if (const auto separator = text(table, "separator"); !separator.empty()) {
      if (separator != ";" && separator != "," && separator != "tab" && separator != "blank")
        fail(table, "separator", "\";\", \",\", \"tab\" or \"blank\"");
      mapping_.table.separator = separator == "tab" ? '\t' : separator == "blank" ? ' ' : separator[0];
    }
    if (const auto decimal = text(table, "decimal"); !decimal.empty()) {
      if (decimal != "," && decimal != ".") fail(table, "decimal", "\",\" or \".\"");
      mapping_.table.decimal = decimal[0];
    }
    if (const auto* line = table.get("header_line")) {
      const auto number = line->value<std::int64_t>();
      if (!line->is_integer() || *number < 1) fail(table, "header_line", "the number of a line, from 1");
      mapping_.table.header_line = static_cast<std::size_t>(*number);
    }
  }

  void read_time(const toml::table& time) {
    allow(time, "time", {"column", "unit", "period"});
    mapping_.table.time_column = text(time, "column");
    mapping_.table.time_unit = text(time, "unit");
    const auto period = text(time, "period");
    if (period.empty() == mapping_.table.time_column.empty())
      document_.fail(time.source(), "time", period.empty() ? "neither column nor period" : "column and period",
                     "one of them");
    if (period.empty()) return;
    try {
      mapping_.table.period = machine::parse_quantity(period, "s");
    } catch (const machine::UnitError& error) {
      fail(time, "period", fmt::format("a time like \"1 ms\" ({})", error.what()));
    }
    if (!(mapping_.table.period > 0.0)) fail(time, "period", "a time above 0");
  }

  void read_channel(const toml::table& table) {
    allow(table, "channel", {"from", "to", "unit", "amperes", "reverse", "fill", "scaling"});
    MappedChannel channel;
    channel.place = fmt::format("{}:{}", name_, table.source().begin.line);
    channel.from = text(table, "from");
    if (channel.from.empty()) fail(table, "from", "the name of a channel in the recording");
    const auto to = text(table, "to");
    const auto split = split_channel_name(to);
    channel.to = find_channel(split.name);
    channel.axis = split.axis;
    channel.name = split.name;
    if (channel.to == nullptr || !split.unit.empty()) {
      std::string known;
      for (const auto& each : log_channels) {
        known += fmt::format("{}{}", known.empty() ? "" : ", ", each.name);
        if (each.rotary_name != nullptr && each.rotary_name != std::string_view(each.name))
          known += fmt::format(", {}", each.rotary_name);
      }
      fail(table, "to", fmt::format("a channel, with its axis where there are several (\"X.x\"): {}", known));
    }
    channel.unit = text(table, "unit");
    channel.factor = amperes(table, to, *channel.to);
    if (const auto* reverse = table.get("reverse")) {
      if (!reverse->is_boolean()) fail(table, "reverse", "true or false");
      if (*reverse->value<bool>()) channel.factor = -channel.factor;
    }
    if (const auto fill = text(table, "fill"); !fill.empty()) {
      if (fill != "hold" && fill != "linear") fail(table, "fill", "\"hold\" or \"linear\"");
      channel.fill = fill == "hold" ? MappedChannel::Fill::hold : MappedChannel::Fill::linear;
    }
    if (const auto scaling = text(table, "scaling"); !scaling.empty()) {
      if (scaling != "done" && scaling != "apply") fail(table, "scaling", "\"done\" or \"apply\"");
      channel.scaling = scaling == "done" ? MappedChannel::Scaling::done : MappedChannel::Scaling::apply;
    }
    for (const auto& other : mapping_.channels)
      if (other.to == channel.to && other.axis == channel.axis)
        document_.fail(place(table, "to"), "to", fmt::format("\"{}\" a second time", to), "every channel once");
    mapping_.channels.push_back(std::move(channel));
  }

  // sqrt(2) for the rms value of a current that is kept as amplitude.
  double amperes(const toml::table& table, const std::string& to, const LogChannel& channel) const {
    const auto stated = text(table, "amperes");
    if (std::string_view(channel.unit) != "A") {
      if (!stated.empty()) fail(table, "amperes", fmt::format("none, as {} is not a current", to));
      return 1.0;
    }
    if (stated == "peak") return 1.0;
    if (stated == "rms") return std::numbers::sqrt2;
    fail(table, "amperes",
         fmt::format("amperes = \"peak\" or amperes = \"rms\" for the current {}: the manual of the drive states "
                     "which; a wrong choice is an error of 41 %",
                     to));
  }

  std::string name_;
  machine::Document document_;
  Mapping mapping_;
};

bool same_times(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  const double step = (a.back() - a.front()) / static_cast<double>(std::max<std::size_t>(1, a.size() - 1));
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::abs(a[k] - b[k]) > step_tolerance * step) return false;
  return true;
}

// `channel` on the times `t` of which it has one piece without holes, NaN before and behind it; what lies before or
// behind `t` is left out. None: it has other times.
std::optional<std::vector<double>> aligned(const RecordedChannel& channel, const std::vector<double>& t) {
  const double step = (t.back() - t.front()) / static_cast<double>(std::max<std::size_t>(1, t.size() - 1));
  const double near = step_tolerance * step;
  std::vector<double> values(t.size(), std::numeric_limits<double>::quiet_NaN());
  std::size_t k = 0, at = 0, found = 0;
  while (at < channel.t.size() && channel.t[at] < t.front() - near) ++at;
  while (k < t.size() && at < channel.t.size() && t[k] < channel.t[at] - near) ++k;
  for (; k < t.size() && at < channel.t.size(); ++k, ++at, ++found) {
    if (std::abs(channel.t[at] - t[k]) > near) return std::nullopt;
    values[k] = channel.values[at];
  }
  if (found < 2) return std::nullopt;
  return values;
}

// `channel` at the times `t`; before its first sample the first counts, behind the last the last.
std::vector<double> filled(const RecordedChannel& channel, const std::vector<double>& t, MappedChannel::Fill fill) {
  std::vector<double> values;
  std::size_t at = 0;
  for (const double time : t) {
    while (at + 1 < channel.t.size() && channel.t[at + 1] <= time) ++at;
    double value = channel.values[at];
    if (fill == MappedChannel::Fill::linear && at + 1 < channel.t.size() && time > channel.t[at])
      value += (channel.values[at + 1] - value) * (time - channel.t[at]) / (channel.t[at + 1] - channel.t[at]);
    values.push_back(value);
  }
  return values;
}

class Applier {
 public:
  Applier(const Mapping& mapping, const Recording& recording) : mapping_(mapping), recording_(recording) {}

  Log apply() {
    if (mapping_.has_table_keys && recording_.kind != "a table")
      throw LogError(
          fmt::format("{}: found [table] or [time]; expected none, as {} is {}, which contains this information",
                      mapping_.source, recording_.source, recording_.kind));
    const auto& clock = clock_channel();
    log_.source = recording_.source;
    log_.comments = recording_.comments;
    log_.t = clock.t;
    for (std::size_t k = 1; k < log_.t.size(); ++k)
      if (!(log_.t[k] > log_.t[k - 1]))
        throw LogError(
            fmt::format("{}: found the time {:.10g} s; expected one after that of the sample before "
                        "({:.10g} s)",
                        place_of(recording_, clock, k), log_.t[k], log_.t[k - 1]));
    for (const auto& mapped : mapping_.channels)
      axis_of(log_, mapped.axis).*mapped.to->values = values_of(mapped, usable(mapped));
    for (const auto& channel : recording_.channels)
      if (std::ranges::none_of(mapping_.channels, [&](const auto& m) { return m.from == channel.name; }))
        log_.ignored.push_back(channel.name);
    share_channels(log_);
    kinds_.mark(log_);
    require_channels(log_, mapping_.source);
    check_sampling(log_, recording_.digits, [&](std::size_t k) { return place_of(recording_, clock, k); });
    return std::move(log_);
  }

 private:
  const RecordedChannel& clock_channel() const {
    for (const auto& mapped : mapping_.channels)
      if (std::string_view(mapped.to->name) == "x") return usable(mapped);
    throw LogError(mapping_.source + ": found no channel with to = \"x\"; expected the measured position");
  }

  const RecordedChannel& usable(const MappedChannel& mapped) const {
    const RecordedChannel* found = nullptr;
    std::size_t count = 0;
    for (const auto& channel : recording_.channels)
      if (channel.name == mapped.from) found = &channel, ++count;
    if (count != 1) {
      std::string names;
      for (const auto& channel : recording_.channels)
        if (names.size() < 400) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", excerpt(channel.name, 60));
      throw LogError(fmt::format("{}: found {} '{}' in {}; expected one of: {}", mapped.place,
                                 count == 0 ? "no channel" : "several channels", excerpt(mapped.from, 60),
                                 recording_.source, names));
    }
    if (!found->bad.empty()) throw LogError(found->bad + "; expected a finite number");
    if (found->t.empty())
      throw LogError(fmt::format("{}: found no sample of '{}' in {}; expected some", mapped.place,
                                 excerpt(mapped.from, 60), recording_.source));
    return *found;
  }

  void require_scaling(const MappedChannel& mapped, const RecordedChannel& channel) const {
    if (!channel.scaling || mapped.scaling == MappedChannel::Scaling::done) return;
    const auto& s = *channel.scaling;
    if (!s.known)
      throw LogError(fmt::format(
          "{}: '{}': found a scale factor or an offset in the head of {} whose column cannot be told; expected "
          "scaling = \"done\" where the export was made with scaled values, or an export with a different separator",
          mapped.place, excerpt(mapped.from, 60), recording_.source));
    if (mapped.scaling == MappedChannel::Scaling::unstated)
      throw LogError(fmt::format(
          "{}: '{}': found ScaleFactor {}, Offset {}, Unit ScaleFactor {} and Unit Offset {} in the head of {}, which "
          "does not say whether its values have them already; expected scaling = \"done\" or scaling = \"apply\"",
          mapped.place, excerpt(mapped.from, 60), s.factor, s.offset, s.unit_factor, s.unit_offset, recording_.source));
  }

  std::vector<double> values_of(const MappedChannel& mapped, const RecordedChannel& channel) {
    require_scaling(mapped, channel);
    const auto& unit = mapped.unit.empty() ? channel.unit : mapped.unit;
    UnitScale scale;
    try {
      const auto [found, kind] = channel_scale(*mapped.to, mapped.name, unit);
      scale = found;
      kinds_.add(mapped.axis, kind, fmt::format("{}[{}]", mapped.name, unit), mapped.place);
    } catch (const machine::UnitError& error) {
      throw LogError(fmt::format("{}: '{}': found {} ({}); expected unit = \"...\" of {}, like {}", mapped.place,
                                 excerpt(mapped.from, 60),
                                 unit.empty() ? "no unit" : "the unit '" + excerpt(unit) + "'",
                                 excerpt(error.what(), 120), mapped.to->text, mapped.to->unit));
    }
    std::vector<double> values;
    if (same_times(channel.t, log_.t)) {
      values = channel.values;
    } else if (auto part = mapped.fill == MappedChannel::Fill::none ? aligned(channel, log_.t) : std::nullopt) {
      values = std::move(*part);
    } else {
      if (mapped.fill == MappedChannel::Fill::none)
        throw LogError(
            fmt::format("{}: '{}': found {} samples at other times than the {} of the position; expected the "
                        "same sampling, or fill = \"hold\" or \"linear\" for a slow quantity like a "
                        "temperature",
                        mapped.place, excerpt(mapped.from, 60), channel.t.size(), log_.t.size()));
      values = filled(channel, log_.t, mapped.fill);
    }
    for (double& value : values) {
      const bool blank = std::isnan(value);
      if (channel.scaling && mapped.scaling == MappedChannel::Scaling::apply) value = (*channel.scaling)(value);
      value = scale(value) * mapped.factor;
      if (!blank && !std::isfinite(value))
        throw LogError(
            fmt::format("{}: '{}': found a value beyond the range of double precision; expected a smaller one",
                        mapped.place, excerpt(mapped.from, 60)));
    }
    return values;
  }

  const Mapping& mapping_;
  const Recording& recording_;
  AxisKinds kinds_;
  Log log_;
};

}  // namespace

Mapping read_mapping(const std::filesystem::path& file) { return Reader(file).read(); }

std::optional<Mapping> mapping_by_names(const Recording& recording) {
  Mapping mapping;
  mapping.source = recording.source;
  bool has_position = false;
  for (const auto& recorded : recording.channels) {
    const auto split = split_channel_name(recorded.name);
    const auto* to = find_channel(split.name);
    const auto unit = split.unit.empty() ? std::string_view(recorded.unit) : split.unit;
    if (to == nullptr || (unit.empty() && !to->whole)) continue;
    MappedChannel channel;
    channel.from = recorded.name;
    channel.axis = split.axis;
    channel.name = split.name;
    channel.to = to;
    channel.unit = unit;
    channel.place = recording.source;
    if (to->shared) channel.fill = to->whole ? MappedChannel::Fill::hold : MappedChannel::Fill::linear;
    has_position = has_position || split.name == "x";
    mapping.channels.push_back(std::move(channel));
  }
  return has_position ? std::optional(std::move(mapping)) : std::nullopt;
}

Log apply_mapping(const Mapping& mapping, const Recording& recording) { return Applier(mapping, recording).apply(); }

std::string mapping_hint(const Recording& recording) {
  std::string names;
  for (const auto& channel : recording.channels)
    if (names.size() < 400) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", excerpt(channel.name, 60));
  return fmt::format(
      "{}: found {} with the channels {}; expected --map FILE, which describes them: schema = \"{}\", and for each "
      "[[channel]] from = \"NAME\", to = \"x\", unit = \"mm\" (for a current also amperes = \"peak\" or \"rms\")",
      recording.source, recording.kind, names, schema);
}

}  // namespace stiction::host
