#include "host/sweep/rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/sweep/commands.hpp"
#include "host/sweep/machine_values.hpp"
#include "host/sweep/round_number.hpp"

namespace stiction::host {
namespace {

// As one would type it into a shell.
std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+./:,=") == std::string::npos;
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

double drawn_value(const SweptKey& key, double u) {
  switch (*key.drawn) {
    case Distribution::uniform:
      return round_number(key.low + (key.high - key.low) * u);
    case Distribution::log_uniform:
      return round_number(key.low * std::exp(std::log(key.high / key.low) * u));
    case Distribution::normal:
      break;
  }
  return round_number(key.low + key.high * normal_quantile(u));
}

}  // namespace

std::string SweepRow::option(std::string_view name, const std::string& fallback) const {
  for (const auto& [each, value] : options)
    if (each == name) return value;
  return fallback;
}

SweepRows::SweepRows(const SweepSpec& spec, const SweepCommand& command)
    : spec_(spec), command_(command), size_(spec.rows()) {
  const bool relative =
      std::any_of(spec.keys.begin(), spec.keys.end(), [](const SweptKey& key) { return key.relative; });
  if (!relative) return;
  for (const auto& key : spec.keys)
    if (key.kind == SweptKey::Kind::machine)
      for (const auto& name : key.values)
        machines_.emplace(name, std::make_unique<MachineValues>(name, command.experiment));
}

SweepRows::~SweepRows() = default;

SweepRow SweepRows::values(std::uint64_t index) const {
  SweepRow row;
  const auto count = spec_.keys.size();
  row.numbers.assign(count, std::numeric_limits<double>::quiet_NaN());
  row.texts.resize(count);
  const std::uint64_t draw = index % spec_.samples;
  std::uint64_t rest = index / spec_.samples;
  for (std::size_t k = count; k-- > 0;) {
    const auto& key = spec_.keys[k];
    if (key.drawn) continue;
    const auto at = static_cast<std::size_t>(rest % key.values.size());
    rest /= key.values.size();
    row.texts[k] = key.values[at];
    if (key.numeric) row.numbers[k] = key.numbers[at];
  }
  std::uint32_t dimension = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& key = spec_.keys[k];
    if (!key.drawn) continue;
    row.numbers[k] = drawn_value(key, sample(spec_.method, draw, spec_.samples, dimension++, spec_.seed));
    row.texts[k] = quantity_text(row.numbers[k], key.unit);
  }
  return row;
}

SweepRow SweepRows::row(std::uint64_t index) const {
  auto row = values(index);
  const auto count = spec_.keys.size();
  for (std::size_t k = 0; k < count; ++k) {
    const auto& key = spec_.keys[k];
    switch (key.kind) {
      case SweptKey::Kind::machine:
        row.machine = row.texts[k];
        break;
      case SweptKey::Kind::log:
        row.logs.push_back(row.texts[k]);
        break;
      case SweptKey::Kind::option:
        row.options.emplace_back(key.name, row.texts[k]);
        break;
      case SweptKey::Kind::set:
        if (key.relative) {
          for (auto& each : machines_.at(row.machine)->multiplied(key.name, row.numbers[k]))
            row.set.push_back(std::move(each));
        } else {
          row.set.push_back(key.name + "=" + row.texts[k]);
        }
        break;
    }
  }
  return row;
}

std::string SweepRows::command_line(const SweepRow& row) const {
  std::string line = fmt::format("stiction {}", command_.name);
  for (const auto& log : row.logs)
    line += (command_.log_option.empty() ? " " : fmt::format(" {} ", command_.log_option)) + shell_word(log);
  line += " --machine " + shell_word(row.machine);
  for (const auto& [name, value] : row.options) {
    const bool flag =
        std::find(command_.flags.begin(), command_.flags.end(), std::string_view(name)) != command_.flags.end();
    if (!flag)
      line += fmt::format(" --{} {}", name, shell_word(value));
    else if (value == "true")
      line += fmt::format(" --{}", name);
  }
  for (const auto& each : row.set) line += " --set " + shell_word(each);
  return line;
}

}  // namespace stiction::host
