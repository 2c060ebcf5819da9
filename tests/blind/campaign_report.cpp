#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/blind/campaign.hpp"

namespace stiction::blind {
namespace {

using Outcomes = std::vector<const Outcome*>;
using Holds = bool (*)(const Outcome&);

Outcomes of_kind(const std::vector<Outcome>& outcomes, const std::string& kind) {
  Outcomes chosen;
  for (const auto& each : outcomes)
    if (each.kind->name == kind && each.error.empty()) chosen.push_back(&each);
  return chosen;
}

std::string rate(const std::string& what, const Outcomes& cases, Holds holds, const char* wanted) {
  if (cases.empty()) return "";
  const auto count = std::count_if(cases.begin(), cases.end(), [&](const Outcome* each) { return holds(*each); });
  return fmt::format("{:<64} {:>4} of {:<4} {:5.1f} % {}\n", what, count, cases.size(),
                     100.0 * static_cast<double>(count) / static_cast<double>(cases.size()), wanted);
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

bool names_any(const Outcome& o) { return !o.named.empty(); }
bool names_none(const Outcome& o) { return o.named.empty(); }
bool names_wrongly(const Outcome& o) { return o.wrong > 0; }
bool first_right(const Outcome& o) { return o.first_right; }
bool first_in_class(const Outcome& o) { return o.first_right || o.first_aliased; }
bool first_wrong(const Outcome& o) { return !o.named.empty() && !o.first_right && !o.first_aliased; }
bool exact_set(const Outcome& o) { return o.exact_set; }
bool no_name_but_signature(const Outcome& o) { return o.wrong == 0 && (!o.signature.empty() || o.first_right); }
bool no_false_name(const Outcome& o) { return o.wrong == 0; }

std::string rates(const std::vector<Outcome>& outcomes) {
  std::string text;
  const auto null = of_kind(outcomes, "null");
  text += rate("nothing hidden: some cause is named", null, names_any, "(wanted at most 5 %)");
  for (const auto& [kind, share, wanted] :
       {std::tuple{"one50", "50 %", ""}, std::tuple{"one10", "10 %", "(wanted at least 95 %)"},
        std::tuple{"one5", "5 %", "(wanted at least 80 %)"}, std::tuple{"one2", "2 %", ""}}) {
    const auto cases = of_kind(outcomes, kind);
    text += rate(fmt::format("one at {}: the first name is right (exact aliases count)", share), cases, first_right,
                 wanted);
    text += rate("  right, or declared an alias of the right one", cases, first_in_class, "");
    text += rate("  no name", cases, names_none, "");
    text += rate("  the first name is wrong", cases, first_wrong,
                 kind == std::string("one2") ? "(wanted at most 10 %)" : "");
    text += rate("  some name is wrong", cases, names_wrongly, "");
  }
  const auto two = of_kind(outcomes, "two10");
  text += rate("two at 10 % each: the exact set", two, exact_set, "(wanted at least 85 %)");
  text += rate("  the first name is right", two, first_right, "");
  text += rate("  some name is wrong", two, names_wrongly, "");
  const auto outside = of_kind(outcomes, "outside10");
  text += rate("outside the vocabulary at 10 %: no false name, a signature", outside, no_name_but_signature,
               "(wanted at least 90 %)");
  text += rate("  no false name", outside, no_false_name, "");
  const auto off = of_kind(outcomes, "off");
  text += rate("parameters slightly off: nothing but the matching mismatches", off, no_false_name, "");
  text += rate("  some of them named", off, names_any, "");
  return text;
}

// Hidden against first named, with a NONE row and column; "~": declared an alias of the hidden one.
std::string matrix(const std::vector<Outcome>& outcomes, const std::vector<std::string>& kind_names,
                   const std::string& title) {
  std::vector<std::string> columns;
  for (const auto& row : hideables())
    if (row.in_vocabulary) columns.emplace_back(row.name);
  std::vector<std::string> rows = columns;
  for (const auto& row : hideables())
    if (!row.in_vocabulary) rows.emplace_back(row.name);
  columns.emplace_back("NONE");
  rows.emplace_back("NONE");
  std::map<std::string, std::map<std::string, int>> cells;
  std::map<std::string, int> totals, aliased;
  for (const auto& each : outcomes) {
    if (!each.error.empty() || each.order.hidden.size() > 1 || each.order.slightly_off) continue;
    if (std::find(kind_names.begin(), kind_names.end(), each.kind->name) == kind_names.end()) continue;
    const auto hidden = each.order.hidden.empty() ? "NONE" : each.order.hidden.front();
    const auto named = each.named.empty() ? "NONE" : each.named.front();
    if (std::find(columns.begin(), columns.end(), named) == columns.end()) columns.insert(columns.end() - 1, named);
    ++cells[hidden][named];
    ++totals[hidden];
    aliased[hidden] += each.first_aliased;
  }
  if (totals.empty()) return "";
  std::string text = fmt::format("\n{}: hidden (rows) against the first name (columns)\n{:<30}", title, "");
  for (std::size_t k = 0; k < columns.size(); ++k)
    text += fmt::format("{:>5}", columns[k] == "NONE" ? "NONE" : fmt::format("{}", k + 1));
  text += "  aliases\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!totals.contains(rows[r])) continue;
    const bool has_column = r + 1 < columns.size() && columns[r] == rows[r];
    text += fmt::format("{:<30}", has_column ? fmt::format("{:>2} {}", r + 1, rows[r]) : "   " + rows[r]);
    for (const auto& column : columns) {
      const int count = cells[rows[r]][column];
      text += count > 0 ? fmt::format("{:>5}", count) : fmt::format("{:>5}", ".");
    }
    text += aliased[rows[r]] > 0 ? fmt::format("{:>9}\n", aliased[rows[r]]) : "\n";
  }
  for (std::size_t k = 0; k + 1 < columns.size(); ++k)
    if (k >= rows.size() || columns[k] != rows[k]) text += fmt::format("   column {}: {}\n", k + 1, columns[k]);
  return text;
}

std::string parameters(const std::vector<Outcome>& outcomes) {
  struct Errors {
    std::vector<double> error, of_change;
    int intervals = 0, covered = 0;
    double squares = 0.0;  // of the errors in standard errors
  };
  std::map<std::string, Errors> all;
  int intervals = 0, covered = 0;
  for (const auto& each : outcomes)
    for (const auto& score : each.parameters) {
      auto& errors = all[score.effect + "." + score.key + fmt::format(" at {:.0f} %", 100.0 * each.order.share)];
      errors.error.push_back(score.error);
      if (score.of_change > 0.0) errors.of_change.push_back(score.of_change);
      if (!score.interval) continue;
      const bool inside = std::abs(score.deviations) <= 1.96;
      ++errors.intervals, errors.covered += inside;
      ++intervals, covered += inside;
      errors.squares += score.deviations * score.deviations;
    }
  if (all.empty()) return "";
  std::string text =
      fmt::format("\n{:<44} {:>5} {:>10} {:>10} {:>14} {:>10} {:>16}\n", "Parameter, where its effect was named",
                  "cases", "median", "90 %", "of the change", "covered", "rms off, in s.e.");
  for (const auto& [name, errors] : all)
    text +=
        fmt::format("{:<44} {:>5} {:>8.2f} % {:>8.2f} % {:>14} {:>10} {:>16}\n", name, errors.error.size(),
                    100.0 * quantile(errors.error, 0.5), 100.0 * quantile(errors.error, 0.9),
                    errors.of_change.empty() ? "" : fmt::format("{:.0f} %", 100.0 * quantile(errors.of_change, 0.5)),
                    errors.intervals > 0 ? fmt::format("{}/{}", errors.covered, errors.intervals) : "",
                    errors.intervals > 0 ? fmt::format("{:.2f}", std::sqrt(errors.squares / errors.intervals)) : "");
  if (intervals > 0)
    text += fmt::format("{:<64} {:>4} of {:<4} {:5.1f} % (wanted 90 to 98 %)\n",
                        "95 % intervals that cover the true value", covered, intervals, 100.0 * covered / intervals);
  return text;
}

// Over the cases in which an oracle gains something (0.1 N^2): the sums of both, and how often 80 % of it is reached.
std::string gains(const std::vector<Outcome>& outcomes) {
  std::string text;
  for (const char* kind : {"one50", "one10", "two10"}) {
    double sum = 0.0, oracle = 0.0;
    int count = 0, reached = 0;
    for (const auto* each : of_kind(outcomes, kind)) {
      if (each->oracle_gain < 0.1) continue;
      sum += each->gain, oracle += each->oracle_gain;
      reached += each->gain >= 0.8 * each->oracle_gain;
      ++count;
    }
    if (count > 0)
      text += fmt::format("{:<64} {:5.1f} % of the oracle's in the mean (wanted at least 80 %), reached in {} of {}\n",
                          fmt::format("held-out gain, {}", of_kind(outcomes, kind).front()->kind->text),
                          100.0 * sum / oracle, reached, count);
  }
  return text;
}

// The cases whose first name is not right, or that have a name too many: what was hidden, named, left, and why.
std::string misses(const std::vector<Outcome>& outcomes) {
  std::string text;
  for (const auto& each : outcomes) {
    const bool inside = each.kind->effects > 0, right = inside ? each.exact_set : each.wrong == 0;
    if (!each.error.empty() || (right && (!each.kind->outside || !each.signature.empty()))) continue;
    text += fmt::format("  {} {}: hidden {}; named {}; left: {}{}\n", each.kind->name, each.order.seed,
                        each.order.hidden.empty() ? "nothing" : fmt::format("{}", fmt::join(each.order.hidden, " ")),
                        each.named.empty() ? "nothing" : fmt::format("{}", fmt::join(each.named, " ")),
                        each.signature.empty() ? "nothing" : each.signature,
                        each.why.empty() ? "" : fmt::format("; {}", each.why));
  }
  return text.empty() ? "" : "\nCases that are not right\n" + text;
}

}  // namespace

std::string report(const std::vector<Outcome>& outcomes) {
  std::string text = rates(outcomes);
  const auto gain = gains(outcomes);
  text += gain;
  text += matrix(outcomes, {"one50"}, "Share 50 %");
  text += matrix(outcomes, {"null", "one10", "outside10"}, "Share 10 %");
  text += matrix(outcomes, {"one5", "one2"}, "Share 5 % and 2 %");
  text += parameters(outcomes);
  text += misses(outcomes);
  std::vector<double> seconds;
  for (const auto& each : outcomes) {
    seconds.push_back(each.judge_seconds);
    if (!each.error.empty()) text += fmt::format("seed {}: the diagnosis failed: {}\n", each.order.seed, each.error);
  }
  if (!seconds.empty())
    text += fmt::format("\ntime of a diagnosis: median {:.2f} s, longest {:.2f} s\n", quantile(seconds, 0.5),
                        quantile(seconds, 1.0));
  return text;
}

}  // namespace stiction::blind
