#include "host/report/diagnosis_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/report/assets.hpp"
#include "host/report/chart_json.hpp"
#include "host/report/engineering_unit.hpp"
#include "host/report/next_measurement_section.hpp"
#include "host/report/page.hpp"
#include "host/report/page_data.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

std::string spaced(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

std::string percent(double share) { return fmt::format("{:.{}f}", 100.0 * share, std::abs(share) < 0.1 ? 1 : 0); }
std::string micrometres(double metres) { return fmt::format("{:.2g}", metres * 1e6); }

// One row a value; a list's values are its harmonics or points, counted from 1. As many digits as the interval leaves:
// two of its half width.
void add_rows(json& rows, const EffectParameter& parameter) {
  const auto label = spaced(parameter.key);
  for (std::size_t k = 0; k < parameter.values.size(); ++k) {
    const double value = parameter.values[k];
    const bool known = k < parameter.standard_errors.size() && parameter.standard_errors[k] > 0.0;
    const double half = known ? 1.96 * parameter.standard_errors[k] : 0.0;
    const auto unit = engineering_unit(parameter.unit, std::max(std::abs(value), half));
    const auto number = [&](double v) {
      if (!known) return fmt::format("{:.4g}", v * unit.factor);
      const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(half * unit.factor))), 0, 9);
      return fmt::format("{:.{}f}", v * unit.factor, digits);
    };
    rows.push_back({{"label", parameter.values.size() > 1 ? fmt::format("{} {}", label, k + 1) : label},
                    {"unit", typeset(unit.unit)},
                    {"value", number(value)},
                    {"low", known ? json(number(value - half)) : json(nullptr)},
                    {"high", known ? json(number(value + half)) : json(nullptr)}});
  }
}

std::string gain_percent(double ratio) { return fmt::format("{:.1f}", 100.0 * (1.0 - ratio)); }

std::string change_percent(double ratio) { return fmt::format("{:.1f}", 100.0 * std::abs(1.0 - ratio)); }
const char* falls_or_grows(double ratio) { return ratio <= 1.0 ? "falls" : "grows"; }

// The numbers of the evidence in one sentence.
std::string figures_of(const Finding& finding) {
  auto text = fmt::format(
      "Explains {} % of the {} variance given the other findings (p {}). On held-out data the {} {} by {} % (95 % "
      "interval of the reduction: {} to {} %)",
      percent(finding.explains), finding.in_command ? "command residual" : "residual",
      finding.p_value < 1e-12 ? "< 1e-12" : fmt::format("= {:.1g}", finding.p_value),
      finding.in_command ? "command residual" : "residual force", falls_or_grows(gained_ratio(finding)),
      change_percent(gained_ratio(finding)), gain_percent(finding.holdout.ci95[1]),
      gain_percent(finding.holdout.ci95[0]));
  if (const auto ratio = finding.holdout.position_error_rms_ratio)
    text += fmt::format(", and the position error of the simulation {} by {} %", falls_or_grows(*ratio),
                        change_percent(*ratio));
  return text + ".";
}

std::string on_part(const Finding& finding) {
  if (!finding.part_error)
    return "Not computed: the logs have no set-points with which the simulation could run with and without this cause.";
  return fmt::format("Changes the position error by up to {} µm.", micrometres(*finding.part_error));
}

json cause_json(const Finding& finding) {
  const auto& effect = *finding.effect;
  json parameters = json::array(), confused = json::array();
  for (const auto& parameter : finding.parameters) add_rows(parameters, parameter);
  for (const auto& each : finding.confused_with)
    confused.push_back({{"title", each.effect->title}, {"separate_by", typeset(each.separate_by)}});
  return {{"name", effect.name},
          {"title", effect.title},
          {"axis", finding.axis},
          {"meaning", effect.meaning},
          {"advice", effect.advice},
          {"page", fmt::format("{}/page.md", effect.folder)},
          {"explains", percent(finding.explains)},
          {"gain", gain_percent(gained_ratio(finding))},
          {"gain_interval",
           fmt::format("{} to {}", gain_percent(finding.holdout.ci95[1]), gain_percent(finding.holdout.ci95[0]))},
          {"part", finding.part_error ? json(micrometres(*finding.part_error)) : json(nullptr)},
          {"parameters", parameters},
          {"evidence", typeset(finding.evidence)},
          {"figures", figures_of(finding)},
          {"on_part", on_part(finding)},
          {"confused_with", confused}};
}

// The measured rows of the machine file beside the simulation, with what is off and the causes that change it most.
json rows_json(const ReferenceRows& reference) {
  json rows = json::array();
  const auto number = [](double value, int digits) { return fmt::format("{:.{}f}", value, digits); };
  const auto off = [](double simulated, double measured) {
    return fmt::format("{:+.0f}", std::round(100.0 * (simulated / measured - 1.0)) + 0.0);  // no "-0"
  };
  for (const auto& row : reference.rows) {
    json out{{"axis", row.axis}, {"feed", fmt::format("{:g}", row.feed * 60.0)}, {"training", row.training}};
    const auto add = [&](const char* what, double RowFigures::*member, double scale, int digits) {
      const double measured = row.measured.*member;
      out[what] = {{"measured", number(measured * scale, 1)},
                   {"published", row.published ? json(number((*row.published).*member * scale, 1)) : json(nullptr)},
                   {"published_off", row.published ? json(off((*row.published).*member, measured)) : json(nullptr)},
                   {"machine_file", number(row.machine_file.*member * scale, digits)},
                   {"machine_file_off", off(row.machine_file.*member, measured)},
                   {"extended", number(row.extended.*member * scale, digits)},
                   {"extended_off", off(row.extended.*member, measured)}};
    };
    add("error", &RowFigures::error, 1e6, 1);
    add("current", &RowFigures::current, 1.0, 2);
    std::vector<std::string> causes;
    auto shares = row.shares;
    std::sort(shares.begin(), shares.end(),
              [](const RowShare& a, const RowShare& b) { return std::abs(a.by.current) > std::abs(b.by.current); });
    for (std::size_t k = 0; k < std::min<std::size_t>(shares.size(), 2); ++k)
      causes.push_back(fmt::format("{} {:+.2f} A", shares[k].effect->title, shares[k].by.current));
    out["causes"] = fmt::format("{}", fmt::join(causes, ", "));
    rows.push_back(out);
  }
  return rows;
}

std::string scores_text(const ReferenceRows& reference) {
  const auto line = [](const RowScores& s, double RowScore::*member) {
    return fmt::format("from {} % (published simulation) to {} %", percent(s.published.*member),
                       percent(s.extended.*member));
  };
  return fmt::format(
      "On the held-out feeds the mean deviation of the current falls {}, and that of the error at reversals changes "
      "{}. With each feed left out in turn, that of the current falls {}.",
      line(reference.unused, &RowScore::current), line(reference.unused, &RowScore::error),
      line(reference.left_out, &RowScore::current));
}

std::string headline(const Verdict& verdict) {
  if (verdict.findings.empty())
    return verdict.unexplained.signature
               ? "No known cause explains the residual, but the residual has a repeatable pattern."
               : "The simulation agrees with the data within their noise.";
  std::vector<std::string> names;
  for (const auto& finding : verdict.findings) {
    std::string title(finding.effect->title);
    title[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(title[0])));
    if (std::find(names.begin(), names.end(), title) == names.end()) names.push_back(title);
  }
  return fmt::format("The machine file lacks or misstates: {}.", fmt::join(names, ", "));
}

std::string gain_line(const Verdict& verdict) {
  if (verdict.reference) return scores_text(*verdict.reference);
  const auto& [before, after] = std::pair(verdict.baseline, verdict.extended);
  if (verdict.findings.empty() || before.force_rms <= 0.0) return "";
  // A cause stands that the held-out records do not refute: one that hardly acts there, a gap that swings as it likes.
  auto text =
      after.force_rms < before.force_rms
          ? fmt::format(
                "With the extended machine file, the residual force on held-out data falls from {:.3g} N to {:.3g} N "
                "rms",
                before.force_rms, after.force_rms)
          : fmt::format(
                "With the extended machine file, the residual force on held-out data does not fall ({:.3g} N rms)",
                after.force_rms);
  if (before.position_error_rms && after.position_error_rms)
    text += fmt::format(", the position error of the simulation from {} µm to {} µm rms",
                        micrometres(*before.position_error_rms), micrometres(*after.position_error_rms));
  if (before.command_rms && after.command_rms && *after.command_rms < *before.command_rms)
    text += fmt::format(
        ", the command residual (recorded controller output minus that of the machine file) from {:.2g} to {:.2g} {} "
        "rms",
        *before.command_rms, *after.command_rms, verdict.command_unit);
  return text + ".";
}

std::string unexplained_text(const Unexplained& rest) {
  const auto share = fmt::format("{} % of the residual variance is neither explained nor noise", percent(rest.share));
  if (rest.signature) return typeset(fmt::format("{}. Its pattern: {}.", share, *rest.signature));
  return share + "; it does not repeat with position, time or speed.";
}

json residuals_json(const Verdict& verdict) {
  const auto row = [](const ResidualFigures& figures) {
    return json{
        {"force", fmt::format("{:.3g}", figures.force_rms)},
        {"position", figures.position_error_rms ? json(micrometres(*figures.position_error_rms)) : json(nullptr)}};
  };
  return {{"baseline", row(verdict.baseline)}, {"extended", row(verdict.extended)}};
}

std::string files(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const auto& path : paths) names.push_back(std::filesystem::path(path).filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

json conditions_json(const Verdict& verdict) {
  Conditions conditions;
  conditions.add("Machine file", std::filesystem::path(verdict.machine).filename().string());
  if (verdict.reference) {
    std::vector<std::string> feeds;
    for (const auto& row : verdict.reference->rows)
      if (row.training && row.axis == verdict.reference->rows.front().axis)
        feeds.push_back(fmt::format("{:g}", row.feed * 60.0));
    conditions.add("Measured", "rows of the machine file, " + verdict.reference->reference);
    conditions.add("Training", fmt::format("circle at {} m/min, steady friction, presliding", fmt::join(feeds, ", ")));
    conditions.add("Held-out data", "circles at all other feeds");
    return conditions.json();
  }
  conditions.add("Logs", files(verdict.logs));
  conditions.add("Held-out data", verdict.holdout_is_a_part ? "the last third of each log" : files(verdict.holdout));
  return conditions.json();
}

}  // namespace

std::string diagnosis_report_html(const DiagnosisReport& report) {
  const auto& verdict = report.verdict;
  std::vector<sim::Chart> all = verdict.before_after;
  json charts = json::array(), causes = json::array(), rejected = json::array(), notes = json::array();
  for (const auto& chart : verdict.before_after) charts.push_back(chart_json(chart, "before-after"));
  for (const auto& finding : verdict.findings) {
    for (const auto& chart : finding.charts) {
      charts.push_back(chart_json(chart, fmt::format("cause-charts-{}", causes.size())));
      all.push_back(chart);
    }
    causes.push_back(cause_json(finding));
  }
  if (verdict.next)
    for (const auto& chart : verdict.next->charts) {
      charts.push_back(chart_json(chart, "next-charts"));
      all.push_back(chart);
    }
  for (const auto& each : verdict.rejected)
    rejected.push_back({{"title", each.effect->title}, {"why", typeset(each.why)}});
  for (const auto& note : verdict.notes) notes.push_back(typeset(note));
  const json data{
      {"schema", "stiction.diagnosis-report/1"},
      {"conditions", conditions_json(verdict)},
      {"picture", verdict.findings.empty() ? "" : "with the given and with the extended machine file"},
      {"residuals", residuals_json(verdict)},
      {"rows", verdict.reference ? rows_json(*verdict.reference) : json::array()},
      {"holdout", verdict.reference
                      ? "Shares refer to the squares of relative deviations, so that all feeds have equal weight."
                  : verdict.holdout_is_a_part
                      ? "No held-out log was given, so the last third of each log is used. This cannot separate a "
                        "cause from other effects that repeat with the same motion. Record a different trajectory."
                      : "The held-out logs were not used to choose or fit the causes."},
      {"causes", causes},
      {"next", next_measurement_json(verdict.next)},
      {"rejected", rejected},
      {"unexplained", unexplained_text(verdict.unexplained)},
      {"notes", notes},
      {"series", series_json(all)},
      {"charts", charts},
      {"machine", machine_json(report.machine)}};
  return report_page({"Diagnosis: " + report.machine.name, report.command, report.version}, assets::diagnosis_html(),
                     {{"verdict", escape_html(headline(verdict))}, {"gain", escape_html(gain_line(verdict))}}, data,
                     {assets::charts_js(), assets::diagnosis_js()});
}

}  // namespace stiction::host
