#include "firmware/machine/file/reference_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/parameters.hpp"
#include "firmware/machine/model/coordinate.hpp"

namespace stiction::machine {
namespace {

std::string unit_of_key(const KeyDescription& key) {
  if (key.unit.empty()) return "";
  std::string unit = key.unit == "1" ? "–" : fmt::format("`{}`", key.unit);
  if (!key.unit_of_force_motor.empty()) unit += fmt::format(", force motor `{}`", key.unit_of_force_motor);
  return key.list ? fmt::format("list of {}", unit) : unit;
}

std::string heading(const TableDescription& table) {
  return table.name.empty() ? "The file itself" : fmt::format("`[{}]`", table.name);
}

std::string rotary_section() {
  std::string section =
      "\n## Rotary axes and motors\n\n"
      "With `kind = \"rotary\"` every table of the axis has the units below, and so has the table of a motor behind a "
      "transmission; friction models and effects keep their keys.\n\n";
  for (const SpelledPair& unit : rotary_units())
    section += fmt::format("- `{}` in place of `{}`\n", unit.rotary, unit.linear);
  for (const SpelledPair& key : rotary_keys())
    section += fmt::format("- the key `{}` in place of `{}`\n", key.rotary, key.linear);
  return section;
}

}  // namespace

std::string reference_page(const Vocabulary& vocabulary) {
  std::string page = fmt::format(
      "# Machine file: all keys\n\n"
      "Format `{}`. A quantity is a text \"NUMBER UNIT\"; any unit of the same dimension as the one shown is accepted. "
      "A plain number is accepted only for a quantity without unit (–). A key that is not listed here is an error. "
      "`[experiment.EXPERIMENT.…]` repeats any key of `timing`, `axis` and `feed_drive` with the value it has in that "
      "experiment; experiments: {}.\n",
      machine_schema, fmt::join(experiment_names, ", "));
  for (const TableDescription& table : machine_file_description(vocabulary)) {
    page += fmt::format("\n## {}\n\n{} ({}).\n\n", heading(table), table.text, table.presence);
    page += "| key | unit | allowed | default | meaning |\n| --- | --- | --- | --- | --- |\n";
    for (const KeyDescription& key : table.keys)
      page += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.key, unit_of_key(key),
                          key.allowed.empty() ? "any" : key.allowed, key.fallback, key.text);
  }
  return page + rotary_section();
}

}  // namespace stiction::machine
