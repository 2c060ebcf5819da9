#include "firmware/machine/file/extended_machine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/document.hpp"
#include "firmware/machine/file/edited_machine.hpp"
#include "firmware/machine/file/expected_parameters.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/parameters.hpp"

namespace stiction::machine {
namespace {

const ValueTable& known_effect(const Vocabulary& vocabulary, std::string_view name) {
  const ValueTable* known = vocabulary.find_effect(name);
  if (known == nullptr) throw ValueError(name, "no such effect", "a known one");
  return *known;
}

std::string value_text(double value, std::string_view unit) {
  return unit == "1" ? fmt::format("{:.7g}", value) : fmt::format("\"{}\"", written_quantity(value, unit));
}

// Of the effects that a kind allows once: whether the file has one that an addition names again.
bool replaces_any(const Machine& machine, const Vocabulary& vocabulary, std::span<const AxisEffects> additions) {
  for (const AxisEffects& addition : additions)
    for (const AxisModel& axis : machine.axes)
      for (const Effect& effect : addition.effects) {
        const ValueTable* kind = vocabulary.find_effect(effect.name);
        const auto is_same = [&](const Effect& other) { return other.name == effect.name; };
        if (axis.name == addition.axis && kind != nullptr && !kind->several &&
            std::any_of(axis.effects.begin(), axis.effects.end(), is_same))
          return true;
      }
  return false;
}

// Puts one effect into the tree of an axis, in the place of one that there may be only once.
void put(toml::table& axis, const Vocabulary& vocabulary, const Effect& effect, const AxisModel& model) {
  toml::array& list = *axis.insert(effect_key, toml::array{}).first->second.as_array();
  if (!known_effect(vocabulary, effect.name).several)
    for (auto it = list.begin(); it != list.end();)
      it = it->at_path(effect_name_key).value<std::string>() == effect.name ? list.erase(it) : it + 1;
  toml::table table =
      toml::parse(effect_table(vocabulary, "X", effect, model.motor.driven_by_volts(), model.coordinate));
  list.push_back(std::move(*table["axis"]["X"][effect_key].as_array()->get(0)->as_table()));
  for (toml::node& element : list)
    if (element.is_table()) element.as_table()->is_inline(false);
}

// Of the machine's axes; check_axes() has found it.
const AxisModel& axis_of(const Machine& machine, const std::string& name) {
  return *std::find_if(machine.axes.begin(), machine.axes.end(),
                       [&](const AxisModel& axis) { return axis.name == name; });
}

std::string rewritten(const std::filesystem::path& file, const Machine& machine, const Vocabulary& vocabulary,
                      const std::vector<std::string>& set, std::span<const MachineEdit> edits,
                      std::span<const AxisEffects> additions) {
  toml::table root = toml::parse(edited_machine(file, set, edits, {}));
  if (!additions.empty()) root.erase(expected_key);
  for (const AxisEffects& addition : additions) {
    toml::table* axis = root["axis"][addition.axis].as_table();
    if (axis == nullptr) continue;
    axis->is_inline(false);
    for (const Effect& effect : addition.effects) put(*axis, vocabulary, effect, axis_of(machine, addition.axis));
  }
  std::ostringstream out;
  out << root << '\n';
  return out.str();
}

bool begins_with(std::string_view line, std::string_view what) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line.substr(first).starts_with(what);
}

// Without the rows [[expected]], which belong to the machine before, and the comment above the first of them.
std::string without_expected(const std::string& text) {
  const std::string header = fmt::format("[[{}]]", expected_key);
  std::vector<std::string> kept;
  std::istringstream lines(text);
  bool in_row = false, any = false;
  for (std::string line; std::getline(lines, line);) {
    if (begins_with(line, header)) {
      while (!any && !kept.empty() && begins_with(kept.back(), "#")) kept.pop_back();
      in_row = any = true;
    } else if (begins_with(line, "[") || begins_with(line, "#")) {
      in_row = false;
    }
    if (!in_row) kept.push_back(line);
  }
  return any ? fmt::format("{}\n", fmt::join(kept, "\n")) : text;
}

std::string continued(std::string text, const Machine& machine, const Vocabulary& vocabulary,
                      std::span<const AxisEffects> additions) {
  if (!additions.empty()) text = without_expected(text);
  if (!text.empty() && text.back() != '\n') text += '\n';
  for (const AxisEffects& addition : additions) {
    const AxisModel& axis = axis_of(machine, addition.axis);
    for (const Effect& effect : addition.effects)
      text += "\n" + effect_table(vocabulary, axis.name, effect, axis.motor.driven_by_volts(), axis.coordinate);
  }
  return text;
}

std::string with_comment(std::string text, std::span<const std::string> comment) {
  if (comment.empty()) return text;
  std::string head;
  for (const std::string& line : comment) head += "# " + line + "\n";
  return head + text;
}

void check_axes(const std::filesystem::path& file, const Machine& machine, std::span<const AxisEffects> additions) {
  std::vector<std::string_view> known;
  for (const AxisModel& axis : machine.axes) known.push_back(axis.name);
  for (const AxisEffects& addition : additions)
    if (std::find(known.begin(), known.end(), addition.axis) == known.end())
      throw MachineFileError(fmt::format("{}: axis: found effects for the axis \"{}\"; expected one of {}",
                                         file.string(), addition.axis, quoted_list(known)));
}

}  // namespace

std::string effect_table(const Vocabulary& vocabulary, const std::string& axis, const Effect& effect, bool force_motor,
                         const Coordinate& coordinate) {
  const ValueTable& kind = known_effect(vocabulary, effect.name);
  check_values(kind, effect.values);
  std::string text = fmt::format("[[axis.{}.{}]]\n{} = \"{}\"\n", axis, effect_key, effect_name_key, effect.name);
  for (const ValueKey& key : kind.keys) {
    const auto found = effect.values.find(key.key);
    if (found == effect.values.end() && key.optional) continue;
    const auto values = found == effect.values.end() ? std::vector{key.fallback.value_or(0.0)} : found->second;
    std::vector<std::string> texts;
    const auto own =
        coordinate.own(force_motor && !key.unit_of_force_motor.empty() ? key.unit_of_force_motor : key.unit);
    for (const double value : values) texts.push_back(value_text(own.from_linear(value), own.unit));
    text += key.list ? fmt::format("{} = [{}]\n", key.key, fmt::join(texts, ", "))
                     : fmt::format("{} = {}\n", key.key, texts.front());
  }
  return text;
}

std::string edited_machine(const std::filesystem::path& file, const Vocabulary& vocabulary,
                           const std::vector<std::string>& set, std::span<const MachineEdit> edits,
                           std::span<const AxisEffects> additions, std::span<const std::string> comment) {
  if (additions.empty()) return edited_machine(file, set, edits, comment);
  const Machine machine = parse_machine(file.string(), content_of(file), vocabulary, {{}, set});
  check_axes(file, machine, additions);
  return with_comment(rewritten(file, machine, vocabulary, set, edits, additions), comment);
}

std::string extended_machine(const std::filesystem::path& file, const Vocabulary& vocabulary,
                             const std::vector<std::string>& set, std::span<const AxisEffects> additions,
                             std::span<const std::string> comment) {
  const std::string original = content_of(file);
  const Machine machine = parse_machine(file.string(), original, vocabulary, {{}, set});
  check_axes(file, machine, additions);
  if (set.empty() && !replaces_any(machine, vocabulary, additions)) {
    std::string text = with_comment(continued(original, machine, vocabulary, additions), comment);
    try {
      const bool other_machine = !additions.empty();
      if (parse_machine(file.string(), text, vocabulary).expected.empty() || !other_machine) return text;
    } catch (const MachineFileError&) {
      // The file writes its axis or its effects in a way that no table can follow.
    }
  }
  std::string text = with_comment(rewritten(file, machine, vocabulary, set, {}, additions), comment);
  parse_machine(file.string(), text, vocabulary);
  return text;
}

}  // namespace stiction::machine
