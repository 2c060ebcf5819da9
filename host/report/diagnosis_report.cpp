#include "host/report/diagnosis_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/report/assets.hpp"
#include "host/report/chart_json.hpp"
#include "host/report/diagnosis_finding.hpp"
#include "host/report/engineering_unit.hpp"
#include "host/report/next_measurement_section.hpp"
#include "host/report/page.hpp"
#include "host/report/page_data.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;
using namespace std::string_literals;

constexpr std::size_t most_rows = 20;  // of a parameter without errors: a longer list is a table of the machine file

std::string spaced(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

// One row a value; a list's values are its harmonics or points, counted from 1. As many digits as the interval leaves:
// two of its half width.
void add_rows(json& rows, const EffectParameter& parameter) {
  const auto label = spaced(parameter.key);
  if (parameter.standard_errors.empty() && parameter.values.size() > most_rows) {
    const auto [least, most] = std::minmax_element(parameter.values.begin(), parameter.values.end());
    const auto unit = engineering_unit(parameter.unit, std::max(std::abs(*least), std::abs(*most)));
    rows.push_back({{"label", label},
                    {"unit", typeset(unit.unit)},
                    {"value", fmt::format("{} values, {:.3g} to {:.3g}", parameter.values.size(), *least * unit.factor,
                                          *most * unit.factor)},
                    {"half", nullptr},
                    {"low", nullptr},
                    {"high", nullptr}});
    return;
  }
  for (std::size_t k = 0; k < parameter.values.size(); ++k) {
    const double value = parameter.values[k];
    const bool known = k < parameter.standard_errors.size() && parameter.standard_errors[k] > 0.0;
    const double half = known ? 1.96 * parameter.standard_errors[k] : 0.0;
    const auto unit = engineering_unit(parameter.unit, std::max(std::abs(value), half));
    const int digits = known ? std::clamp(1 - static_cast<int>(std::floor(std::log10(half * unit.factor))), 0, 9) : 0;
    const auto number = [&](double v) {
      if (!known) return fmt::format("{:.4g}", v * unit.factor);
      return fmt::format("{:.{}f}", v * unit.factor, digits);
    };
    rows.push_back({{"label", parameter.values.size() > 1 ? fmt::format("{} {}", label, k + 1) : label},
                    {"unit", typeset(unit.unit)},
                    {"value", number(value)},
                    {"half", known ? json(fmt::format("{:.{}f}", half * unit.factor, digits)) : json(nullptr)},
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
      percent(finding.explains), finding.residual == Residual::force ? "residual" : residual_words(finding.residual),
      finding.p_value < 1e-12 ? "< 1e-12" : fmt::format("= {:.1g}", finding.p_value), residual_words(finding.residual),
      falls_or_grows(gained_ratio(finding)), change_percent(gained_ratio(finding)),
      gain_percent(finding.holdout.ci95[1]), gain_percent(finding.holdout.ci95[0]));
  if (const auto ratio = finding.holdout.position_error_rms_ratio)
    text += fmt::format(", and the position error of the simulation {} by {} %", falls_or_grows(*ratio),
                        change_percent(*ratio));
  return text + ".";
}

// How sure the name is: its odds by these records, and whether it needs one of them.
std::string how_sure(const Finding& finding) {
  auto text = finding.probability > 0.995 ? std::string("over 99 % likely")
                                          : fmt::format("{:.0f} % likely", 100.0 * finding.probability);
  if (const auto& each = finding.without_each_log)
    text += fmt::format("; named in {} of {} searches, each without a part of the logs", each->named, each->searches);
  return text;
}

std::string on_part(const Finding& finding, const ShownQuantity& deviation) {
  if (!finding.part_error)
    return "Not computed: the logs have no set-points with which the simulation could run with and without this cause.";
  const auto withheld =
      finding.withheld.empty() ? std::string() : fmt::format(" extended.toml lacks its keys: {}.", finding.withheld);
  return typeset(fmt::format("Changes the position error by up to {} {}.{}",
                             deviation_text(*finding.part_error, deviation), deviation.unit, withheld));
}

json cause_json(const Finding& finding, const Verdict& verdict) {
  const auto& deviation = verdict.units.deviation;
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
          {"residual", residual_words(finding.residual)},
          {"gain", gain_percent(gained_ratio(finding))},
          {"gain_interval",
           fmt::format("{} to {}", gain_percent(finding.holdout.ci95[1]), gain_percent(finding.holdout.ci95[0]))},
          {"part", finding.part_error ? json(deviation_text(*finding.part_error, deviation)) : json(nullptr)},
          {"small_below",
           verdict.is_small(finding) ? json(deviation_text(*verdict.small_below, deviation)) : json(nullptr)},
          // There are odds of the residual force alone.
          {"sure", verdict.reference || finding.residual != Residual::force ? json(nullptr) : json(how_sure(finding))},
          {"parameters", parameters},
          {"evidence", typeset(finding.evidence)},
          {"figures", figures_of(finding)},
          {"on_part", on_part(finding, deviation)},
          {"withheld", !finding.withheld.empty()},
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

std::string rows_note(const ReferenceRows& reference) {
  return fmt::format(
      "Shares refer to the squares of relative deviations, so that all feeds have equal weight. With each feed left "
      "out in turn, the mean deviation of the current goes from {} % (published simulation) to {} %.",
      percent(reference.left_out.published.current), percent(reference.left_out.extended.current));
}

std::string unexplained_text(const Unexplained& rest) {
  const auto share = fmt::format("{} % of the residual variance is neither explained nor noise", percent(rest.share));
  if (rest.signature) return typeset(fmt::format("{}. Its pattern: {}.", share, *rest.signature));
  return share + "; it does not repeat with position, time or speed.";
}

json residuals_json(const Verdict& verdict) {
  const auto &force = verdict.units.force, &deviation = verdict.units.deviation;
  const auto row = [&](const ResidualFigures& figures) {
    return json{{"force", fmt::format("{:.3g}", force(figures.force_rms))},
                {"position", figures.position_error_rms ? json(deviation_text(*figures.position_error_rms, deviation))
                                                        : json(nullptr)}};
  };
  json out{{"baseline", row(verdict.baseline)},
           {"extended", row(verdict.extended)},
           {"noise", nullptr},
           {"force_unit", force.unit},
           {"position_unit", typeset(deviation.unit)}};
  if (verdict.noise_floor)
    out["noise"] = {{"force", fmt::format("{:.3g}", force(verdict.noise_floor->force()))},
                    {"position", deviation_text(verdict.noise_floor->position, deviation)}};
  return out;
}

std::string files(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const auto& path : paths) names.push_back(std::filesystem::path(path).filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

Origin origin_of(const DiagnosisReport& report) {
  auto origin = report.origin;
  const auto& verdict = report.verdict;
  if (origin.sources.empty()) {
    origin.sources = verdict.logs;
    origin.sources.insert(origin.sources.end(), verdict.holdout.begin(), verdict.holdout.end());
  }
  if (origin.sources.empty() && verdict.reference)
    origin.sources = {"measured rows of the machine file, " + verdict.reference->reference};
  if (origin.machine_files.empty()) origin.machine_files = {verdict.machine};
  return origin;
}

json conditions_json(const Verdict& verdict) {
  Conditions conditions;
  if (verdict.reference) {
    std::vector<std::string> feeds;
    for (const auto& row : verdict.reference->rows)
      if (row.training && row.axis == verdict.reference->rows.front().axis)
        feeds.push_back(fmt::format("{:g}", row.feed * 60.0));
    conditions.add("Training", fmt::format("circle at {} m/min, steady friction, presliding", fmt::join(feeds, ", ")));
    conditions.add("Held-out data", "circles at all other feeds");
    return conditions.json();
  }
  if (!verdict.axis.empty()) conditions.add("Axis", verdict.axis);
  conditions.add("Training", files(verdict.logs));
  conditions.add("Held-out data", verdict.holdout_is_a_part ? "the last third of each log" : files(verdict.holdout));
  if (verdict.agreement) conditions.add("Agreement", std::string(name_of(verdict.agreement->status)));
  if (!verdict.identified.empty()) conditions.add("Mass and friction", "identified from the training logs first");
  if (!verdict.closed_loop_withheld.empty())
    conditions.add("Closed loop", "withheld: " + typeset(verdict.closed_loop_withheld));
  return conditions.json();
}

}  // namespace

std::string diagnosis_report_html(const DiagnosisReport& report) {
  const auto& verdict = report.verdict;
  std::vector<sim::Chart> all = verdict.before_after;
  json charts = json::array(), causes = json::array(), rejected = json::array(), notes = json::array();
  // A chart without a title shows the record of the one above; the others are of several records.
  std::string record;
  for (const auto& chart : verdict.before_after) {
    if (!chart.title.empty()) record = chart.title;
    charts.push_back(chart_json(chart, "before-after", record));
  }
  for (const std::size_t place : told_by_position(verdict.findings)) {
    const auto& finding = verdict.findings[place];
    for (const auto& chart : finding.charts) {
      charts.push_back(chart_json(chart, fmt::format("cause-charts-{}", causes.size()), ""));
      all.push_back(chart);
    }
    causes.push_back(cause_json(finding, verdict));
  }
  if (verdict.next)
    for (const auto& chart : verdict.next->charts) {
      charts.push_back(chart_json(chart, "next-charts", "next"));
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
      {"holdout", verdict.reference ? rows_note(*verdict.reference)
                  : verdict.holdout_is_a_part
                      ? "No held-out log was given, so the last third of each log is used. This cannot separate a "
                        "cause from other effects that repeat with the same motion. Record a different trajectory."s
                      : "The held-out logs were not used to choose or fit the causes."s},
      {"causes", causes},
      {"next", next_measurement_json(verdict.next, report.suffix)},
      {"rejected", rejected},
      {"unexplained", unexplained_text(verdict.unexplained)},
      {"notes", notes},
      {"series", series_json(all)},
      {"charts", charts},
      {"machine", machine_json(report.machine)}};
  auto title = "Diagnosis: " + report.machine.name;
  if (!verdict.axis.empty() && report.machine.axes.size() > 1) title += ", axis " + verdict.axis;
  return report_page({"Diagnosis", title, diagnosis_sentence(verdict), report.command, report.version,
                      name_and_id(report.machine), origin_of(report)},
                     assets::diagnosis_html(), {}, data, {assets::charts_js(), assets::diagnosis_js()});
}

std::string diagnosis_page_of(const std::string& axis) {
  return axis.empty() ? "report.html" : "report_" + axis + ".html";
}

namespace {

// "axis X agrees (1.2 N rms of residual force)", "axis Y does not agree (83 → 2.4 N rms with 1 cause)".
std::string axis_clause(const Verdict& verdict) {
  const auto& force = verdict.units.force;
  const auto status = verdict.agreement ? verdict.agreement->status : Status::cannot_tell;
  const auto words = status == Status::cannot_tell ? "cannot be told to agree" : std::string(name_of(status));
  const auto named = named_causes(verdict.findings);
  if (verdict.findings.empty())
    return fmt::format("axis {} {} ({:.3g} {} rms of residual force)", verdict.axis, words,
                       force(verdict.baseline.force_rms), force.unit);
  return fmt::format("axis {} {} ({:.3g} → {:.3g} {} rms with {} {})", verdict.axis, words,
                     force(verdict.baseline.force_rms), force(verdict.extended.force_rms), force.unit, named,
                     named == 1 ? "cause" : "causes");
}

}  // namespace

std::string diagnosed_axes_html(const std::vector<Verdict>& verdicts, const DiagnosisReport& frame) {
  std::string rows, names;
  std::vector<std::string> sentences;
  for (const auto& verdict : verdicts) {
    rows += fmt::format("<h2><a href=\"{}\">Axis {}</a></h2><p>{}</p>", escape_html(diagnosis_page_of(verdict.axis)),
                        escape_html(verdict.axis), escape_html(diagnosis_sentence(verdict)));
    sentences.push_back(axis_clause(verdict));
  }
  DiagnosisReport report = frame;
  report.verdict = verdicts.front();
  return report_page({"Diagnosis", "Diagnosis: " + frame.machine.name,
                      fmt::format("Simulation and log: {}.", fmt::join(sentences, "; ")), frame.command, frame.version,
                      name_and_id(frame.machine), origin_of(report)},
                     assets::axes_html(), {{"axes", rows}}, {{"machine", machine_json(frame.machine)}},
                     {assets::axes_js()});
}

}  // namespace stiction::host
