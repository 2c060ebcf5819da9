#include "host/output/experiment_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "host/report/experiment_table.hpp"

namespace stiction::host {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 11> key_spellings{{{"/", "_per_"},
                                                                                       {" ", "_"},
                                                                                       {"·", "_"},
                                                                                       {"^", ""},
                                                                                       {"²", "2"},
                                                                                       {"%", "percent"},
                                                                                       {"°", "deg"},
                                                                                       {"Ω", "Ohm"},
                                                                                       {"µ", "u"},  // micro sign
                                                                                       {"μ", "u"},  // Greek letter
                                                                                       {"±", ""}}};

std::string spelled_for_key(std::string_view unit) {
  std::string key;
  for (std::size_t at = 0; at < unit.size();) {
    std::string_view from = unit.substr(at, 1), to = from;
    for (const auto& [sign, spelling] : key_spellings)
      if (unit.substr(at, sign.size()) == sign) from = sign, to = spelling;
    key += to;
    at += from.size();
  }
  return key;
}

constexpr std::size_t terminal_width = 100;

// `text` in lines behind `head`, the following ones indented as deep.
std::string paragraph(const std::string& head, const std::string& text) {
  std::string out, line = head;
  const std::string indent(head.size(), ' ');
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() > head.size() && line.size() + 1 + word.size() > terminal_width) {
      out += line + "\n";
      line = indent;
    }
    line += (line.size() > head.size() ? " " : "") + word;
  }
  return out + line + "\n";
}

std::string mark_of(const FigureRow& row) {
  if (!row.holds) return "";
  return *row.holds ? "as expected" : "DIFFERS";
}

// Where the source stands in the list, from 1; it is added at its first mention.
std::size_t number_of(std::vector<std::string>& sources, const std::string& source) {
  auto place = std::find(sources.begin(), sources.end(), source);
  if (place == sources.end()) place = sources.insert(sources.end(), source);
  return static_cast<std::size_t>(place - sources.begin()) + 1;
}

std::string table_text(const std::vector<FigureRow>& rows, std::vector<std::string>& sources) {
  std::size_t text_width = 6, friction_width = 0, unit_width = 4, value_width = 5;
  for (const auto& row : rows) {
    text_width = std::max(text_width, row.text.size());
    friction_width = std::max(friction_width, row.friction.size());
    unit_width = std::max(unit_width, row.unit.size());
    value_width = std::max({value_width, row.value.size(), row.expected.size()});
  }
  if (friction_width > 0) friction_width = std::max<std::size_t>(friction_width, 8);
  const auto line = [&](const std::string& text, const std::string& friction, const std::string& value,
                        const std::string& unit, const std::string& expected, const std::string& mark) {
    auto out = fmt::format("{:<{}}  {:<{}}  {:>{}} {:<{}}  {:<24} {}", text, text_width, friction, friction_width,
                           value, value_width, unit, unit_width, expected, mark);
    return out.substr(0, out.find_last_not_of(' ') + 1) + "\n";
  };
  std::string out = line("figure", friction_width > 0 ? "friction" : "", "value", "unit",
                         fmt::format("{:>{}}", "expected", std::max<std::size_t>(value_width, 8)), "");
  for (const auto& row : rows) {
    std::string expected;
    if (row.holds)
      expected = fmt::format("{:>{}} +- {} [{}]", row.expected, std::max<std::size_t>(value_width, 8), row.tolerance,
                             number_of(sources, row.source));
    out += line(&row != &rows.front() && (&row)[-1].text == row.text ? "" : row.text, row.friction, row.value, row.unit,
                expected, mark_of(row));
  }
  return out;
}

}  // namespace

std::string figure_key(const sim::Figure& figure) {
  return figure.unit.empty() ? figure.name : figure.name + "_" + spelled_for_key(figure.unit);
}

nlohmann::ordered_json experiment_json(const sim::ExperimentResult& result, const machine::Machine& machine) {
  auto results = nlohmann::ordered_json::object(), expected = results, holds = results;
  for (const auto& figure : result.figures) {
    const auto key = figure_key(figure);
    if (results.contains(key)) throw std::invalid_argument("two figures have the key " + key);
    results[key] = figure.value;
    if (!figure.expected) continue;
    expected[key] = {{"value", figure.expected->value},
                     {"tolerance", figure.expected->tolerance},
                     {"source", figure.expected->source}};
    holds[key] = *figure.holds();
  }
  nlohmann::ordered_json json{{"schema", "stiction." + result.experiment + "/1"}, {"machine", machine.id}};
  if (!result.signals.empty()) json["signals"] = result.signals;
  json["results"] = std::move(results);
  json["expected"] = std::move(expected);
  json["holds"] = std::move(holds);
  json["findings"] = result.findings;
  return json;
}

std::string experiment_text(const sim::ExperimentResult& result, const machine::Machine& machine) {
  std::string text = fmt::format("{}, {}", result.title, machine.name);
  if (!result.signals.empty()) text += fmt::format(", {} signals", result.signals);
  text += "\n\n" + paragraph("asked:  ", result.question);
  for (const auto& finding : result.findings)
    text += paragraph(&finding == &result.findings.front() ? "found:  " : "        ", finding);
  std::vector<std::string> sources;
  text += "\n" + table_text(figure_rows(result), sources);
  for (std::size_t i = 0; i < sources.size(); ++i)
    text += (i == 0 ? "\n" : "") + fmt::format("[{}] {}\n", i + 1, sources[i]);
  return text + "\n" + verdict(result) + "\n";
}

}  // namespace stiction::host
