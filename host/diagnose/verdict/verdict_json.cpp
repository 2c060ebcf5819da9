#include "host/diagnose/verdict/verdict_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace stiction::host {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_list(const std::vector<double>& values, bool list) {
  return list || values.size() != 1 ? Json(values) : Json(values.front());
}

std::string named(const char* quantity, const ShownQuantity& shown) { return quantity + sim::unit_suffix(shown.unit); }

Json figures(const ResidualFigures& f, const Verdict& verdict) {
  const auto &force = verdict.units.force, &deviation = verdict.units.deviation;
  Json out{{named("force_rms", force), force(f.force_rms)}};
  if (f.position_error_rms) out[named("position_error_rms", deviation)] = deviation(*f.position_error_rms);
  if (f.command_rms) out["command_rms_" + verdict.command_unit] = *f.command_rms;
  return out;
}

Json finding_json(const Finding& f, const Verdict& verdict) {
  const auto& units = verdict.units;
  Json parameters = Json::object(), errors = Json::object();
  for (const auto& p : f.parameters) {
    parameters[p.name()] = number_or_list(p.values, p.list);
    if (!p.standard_errors.empty()) errors[p.name()] = number_or_list(p.standard_errors, p.list);
  }
  Json gain{{"force_rms_ratio", f.holdout.force_rms_ratio}};
  if (f.holdout.position_error_rms_ratio) gain["position_error_rms_ratio"] = *f.holdout.position_error_rms_ratio;
  if (f.holdout.command_rms_ratio) gain["command_rms_ratio"] = *f.holdout.command_rms_ratio;
  if (f.holdout.encoder_rms_ratio) gain["encoder_rms_ratio"] = *f.holdout.encoder_rms_ratio;
  gain["ci95"] = f.holdout.ci95;
  Json confused = Json::array();
  for (const auto& c : f.confused_with)
    confused.push_back({{"effect", c.effect.name()}, {"separate_by", c.separate_by}, {"probability", c.probability}});
  Json out{
      {"effect", f.effect.name()}, {"axis", f.axis},       {"parameters", parameters}, {"standard_errors", errors},
      {"explains", f.explains},    {"holdout_gain", gain}, {"p_value", f.p_value},     {"probability", f.probability},
      {"confused_with", confused}};
  if (f.without_each_log)
    out["without_each_log"] = {{"named", f.without_each_log->named}, {"searches", f.without_each_log->searches}};
  if (f.residual == Residual::command) out["residual"] = "command";
  if (f.residual == Residual::encoders) out["residual"] = "encoders";
  if (f.part_error) out[named("part_error", units.deviation)] = units.deviation(*f.part_error);
  if (f.part_error && verdict.small_below) out["small"] = verdict.is_small(f);
  if (!f.withheld.empty()) out["withheld"] = f.withheld;
  return out;
}

Json cam_json(const NextMeasurement& next, const std::string& axis) {
  constexpr double degrees = 57.295779513082321;
  const auto& cam = *next.cam;
  return {{"file", next_measurement_cam_of(axis)},
          {"law", cam.law},
          {"rise_deg", cam.rise * degrees},
          {"master_speed_rpm", cam.turns},
          {"cycles", cam.cycles},
          {"spectrum", cam.spectrum},
          {"command", next_measurement_command(next, axis)}};
}

Json next_json(const NextMeasurement& next) {
  const auto separation = [](const OpenQuestion& question, double value) {
    return question.by_motion ? Json(value) : Json(nullptr);
  };
  Json questions = Json::array(), trajectories = Json::array();
  for (const auto& q : next.questions)
    questions.push_back({{"effect", q.effect.name()},
                         {"or", q.rival ? Json(q.rival->name()) : Json(nullptr)},
                         {"separate_by", q.separate_by},
                         {"by_motion", q.by_motion},
                         {"standard_errors_of_these_logs", separation(q, q.these_logs)}});
  for (const auto& t : next.trajectories) {
    Json separations = Json::array();
    for (std::size_t k = 0; k < t.separations.size(); ++k)
      separations.push_back(separation(next.questions[k], t.separations[k]));
    trajectories.push_back({{"name", t.name}, {"duration_s", t.duration}, {"standard_errors", separations}});
    if (t.shares.empty()) continue;
    Json shares = Json::array();
    for (std::size_t k = 0; k < t.shares.size(); ++k) shares.push_back(separation(next.questions[k], t.shares[k]));
    trajectories.back()["shares"] = std::move(shares);
  }
  Json out{{"axis", next.axis}, {"log", next.log ? Json(next_measurement_file) : Json(nullptr)}};
  if (next.cam) out["cam"] = cam_json(next, "");
  if (next.log) {
    out["trajectory"] = next.trajectories.front().name;
    out["times"] = next.times;
    out["note"] = next.note;
  }
  out["questions"] = questions;
  out["trajectories"] = trajectories;
  return out;
}

Json row_figures(const RowFigures& f) { return {{"error_um", f.error * 1e6}, {"current_A", f.current}}; }

Json score_json(const RowScore& s) {
  return {{"error_percent", 100.0 * s.error}, {"current_percent", 100.0 * s.current}};
}

Json scores_json(const RowScores& s) {
  return {{"published_simulation", score_json(s.published)},
          {"machine_file", score_json(s.machine_file)},
          {"extended", score_json(s.extended)}};
}

void add_reference(Json& out, const ReferenceRows& reference) {
  Json rows = Json::array();
  for (const auto& row : reference.rows) {
    Json shares = Json::array();
    for (const auto& share : row.shares)
      shares.push_back(
          {{"effect", share.effect.name()}, {"error_um", share.by.error * 1e6}, {"current_A", share.by.current}});
    rows.push_back({{"axis", row.axis},
                    {"feed_m_per_min", row.feed * 60.0},
                    {"used", row.training ? "training" : "held out"},
                    {"measured", row_figures(row.measured)},
                    {"published_simulation", row.published ? row_figures(*row.published) : Json(nullptr)},
                    {"machine_file", row_figures(row.machine_file)},
                    {"extended", row_figures(row.extended)},
                    {"extended_without_this_feed", row_figures(row.left_out)},
                    {"changed_by", shares}});
  }
  out["reference"] = reference.reference;
  out["friction"] = reference.friction;
  out["mean_error_of_feeds_not_used"] = scores_json(reference.unused);
  out["mean_error_leaving_one_feed_out"] = scores_json(reference.left_out);
  out["rows"] = rows;
}

}  // namespace

namespace {

void add_agreement(Json& out, const Verdict& verdict) {
  if (verdict.agreement) {
    out["status"] = name_of(verdict.agreement->status);
    out["status_reason"] = verdict.agreement->reason;
  }
  if (verdict.noise_floor)
    out[named("noise_floor", verdict.units.force)] = verdict.units.force(verdict.noise_floor->force());
  if (verdict.exact_records > 0) out["exact_records"] = verdict.exact_records;
  for (const auto& each : verdict.changed)
    out["changed"].push_back({{"effect", each.effect.name()},
                              {"parameter", each.key + sim::unit_suffix(each.unit)},
                              {"training", each.training},
                              {"held_out", each.held_out},
                              {"standard_error", each.standard_error}});
  if (!verdict.closed_loop_withheld.empty()) out["closed_loop_withheld"] = verdict.closed_loop_withheld;
  if (!verdict.questions.empty()) out["questions"] = verdict.questions;
  if (verdict.identified.empty()) return;
  Json values = Json::array();
  for (const auto& each : verdict.identified)
    values.push_back({{"name", each.name}, {"value", each.value}, {"ci95", each.ci95}});
  out["identified"] = std::move(values);
}

}  // namespace

Json verdict_json(const Verdict& verdict) {
  Json findings = Json::array(), rejected = Json::array();
  for (const auto& f : verdict.findings) findings.push_back(finding_json(f, verdict));
  for (const auto& r : verdict.rejected) rejected.push_back({{"effect", r.effect.name()}, {"why", r.why}});
  Json out{{"schema", "stiction.verdict/1"},
           {"machine", verdict.machine},
           {"logs", verdict.logs},
           {"holdout", verdict.holdout},
           {"holdout_is_a_part", verdict.holdout_is_a_part},
           {"baseline", figures(verdict.baseline, verdict)},
           {"extended", figures(verdict.extended, verdict)},
           {"findings", findings},
           {"rejected", rejected},
           {"unexplained",
            {{"share", verdict.unexplained.share},
             {"signature", verdict.unexplained.signature ? Json(*verdict.unexplained.signature) : Json(nullptr)}}},
           {"notes", verdict.notes},
           {"extended_machine", "extended.toml"}};
  add_agreement(out, verdict);
  if (verdict.next) out["next_measurement"] = next_json(*verdict.next);
  if (verdict.reference) add_reference(out, *verdict.reference);
  return out;
}

std::string next_measurement_file_of(const std::string& axis) {
  return axis.empty() ? next_measurement_file : fmt::format("next_measurement_{}.csv", axis);
}

std::string next_measurement_cam_of(const std::string& axis) {
  return axis.empty() ? next_measurement_cam_file : fmt::format("next_measurement_{}_cam.toml", axis);
}

std::string next_measurement_command(const NextMeasurement& next, const std::string& axis) {
  return fmt::format(
      "stiction simulate cam --machine extended.toml --axis {} --cam {} --speed \"{}\" --cycles {} --log next.csv",
      next.axis, next_measurement_cam_of(axis), next.cam->speed, next.cam->cycles);
}

Json verdict_json(const std::vector<Verdict>& verdicts) {
  if (verdicts.size() == 1) return verdict_json(verdicts.front());
  const auto& first = verdicts.front();
  Json axes = Json::object();
  for (const auto& verdict : verdicts) {
    auto axis = verdict_json(verdict);
    for (const char* common : {"schema", "machine", "logs", "holdout", "holdout_is_a_part", "extended_machine"})
      axis.erase(common);
    if (verdict.next && verdict.next->log) axis["next_measurement"]["log"] = next_measurement_file_of(verdict.axis);
    if (verdict.next && verdict.next->cam) axis["next_measurement"]["cam"] = cam_json(*verdict.next, verdict.axis);
    axes[verdict.axis] = std::move(axis);
  }
  return {{"schema", "stiction.verdict/1"},
          {"machine", first.machine},
          {"logs", first.logs},
          {"holdout", first.holdout},
          {"holdout_is_a_part", first.holdout_is_a_part},
          {"axes", std::move(axes)},
          {"extended_machine", "extended.toml"}};
}

namespace {

std::string rows_text(const ReferenceRows& reference) {
  const auto line = [](const char* what, const char* which, const RowScores& s, double RowScore::*member) {
    return fmt::format(
        "mean deviation of {} {}: published simulation {:.1f} %, machine file {:.1f} %, extended {:.1f} %\n", what,
        which, 100.0 * s.published.*member, 100.0 * s.machine_file.*member, 100.0 * s.extended.*member);
  };
  std::string text =
      line("current", "on the held-out feeds", reference.unused, &RowScore::current) +
      line("error at reversals", "on the held-out feeds", reference.unused, &RowScore::error) +
      line("current", "with each feed left out in turn", reference.left_out, &RowScore::current) +
      line("error at reversals", "with each feed left out in turn", reference.left_out, &RowScore::error) + "\n";
  text +=
      "                     error at reversals, um                           largest current, A\n"
      "axis  m/min  measured  published  simulated  extended    measured  published  simulated  extended\n";
  for (const auto& row : reference.rows) {
    const auto cell = [&](double RowFigures::*member, double scale) {
      return row.published ? fmt::format("{:.1f}", *row.published.*member * scale) : std::string("-");
    };
    text += fmt::format("{:<4} {:>6.1f} {:>9.1f} {:>10} {:>10.2f} {:>9.2f} {:>11.1f} {:>10} {:>10.2f} {:>9.2f}{}\n",
                        row.axis, row.feed * 60.0, row.measured.error * 1e6, cell(&RowFigures::error, 1e6),
                        row.machine_file.error * 1e6, row.extended.error * 1e6, row.measured.current,
                        cell(&RowFigures::current, 1.0), row.machine_file.current, row.extended.current,
                        row.training ? "  (training)" : "");
  }
  return text + "\n";
}

}  // namespace

std::string next_measurement_text(const NextMeasurement& next) {
  std::string text = "next measurement: ";
  if (!next.log) {
    const auto& q = next.questions.front();
    const bool could = !next.trajectories.empty() || !q.by_motion;
    return text + fmt::format("{}; {}",
                              could ? fmt::format("no known motion of axis {} answers the open questions", next.axis)
                                    : "no trajectory could be run in the simulation of the machine file",
                              q.separate_by);
  }
  const auto& best = next.trajectories.front();
  const auto amount = next.cam         ? fmt::format(", {} cycles", next.cam->cycles)
                      : next.times > 1 ? fmt::format(", {} times", next.times)
                                       : std::string();
  text += next.cam ? "the cam " : "";
  text += fmt::format("{}, {:.0f} s{}; expected", best.name, best.duration, amount);
  std::vector<std::string> settled, open;
  for (std::size_t k = 0; k < next.questions.size(); ++k) {
    const auto& q = next.questions[k];
    const auto what =
        q.rival ? fmt::format("{} or {}", q.effect.name(), q.rival->name()) : std::string(q.effect.name());
    if (q.by_motion && best.answers(k))
      settled.push_back(
          fmt::format("{:.1f} standard errors for {} (these logs: {:.1f})", best.separations[k], what, q.these_logs));
    else
      open.push_back(what);
  }
  text += fmt::format(" {}", fmt::join(settled, ", "));
  if (!open.empty()) text += fmt::format("; leaves open {}", fmt::join(open, ", "));
  return next.cam ? text + ". " + next.cam->spectrum : text;
}

namespace {

// "1.23 N rms".
std::string rms_text(const ShownQuantity& shown, double value, int digits) {
  return fmt::format("{:.{}g} {} rms", shown(value), digits, shown.unit);
}

std::string agreement_text(const Verdict& verdict) {
  std::string text;
  if (verdict.noise_floor) {
    const auto& floor = *verdict.noise_floor;
    const auto& force = verdict.units.force;
    text += fmt::format(
        "  {:<14} force {}, position {} (force: encoder {:.3g} {}, clock {:.3g} {}, current, force or voltage {:.3g} "
        "{}, "
        "inverse dynamics {:.3g} {})\n",
        "noise alone", rms_text(force, floor.force(), 4), rms_text(verdict.units.deviation, floor.position, 3),
        force(floor.encoder), force.unit, force(floor.clock), force.unit, force(floor.effort), force.unit,
        force(floor.dynamics), force.unit);
  }
  const bool named = named_causes(verdict.findings) > 0;
  const char* none = named ? "" : "no cause found; ";
  if (!verdict.agreement) return text + (named ? "" : "\nno cause found\n");
  const char* which = verdict.findings.empty() ? "the machine file" : "the extended machine file";
  switch (verdict.agreement->status) {
    case Status::agrees:
      return text + fmt::format("\n{}{} agrees with the data within their noise: {}\n", none, which,
                                verdict.agreement->reason);
    case Status::does_not_agree:
      return text + fmt::format("\n{}{} does not agree with the data; the rest is unexplained: {}\n", none, which,
                                verdict.agreement->reason);
    case Status::cannot_tell:
      return text + fmt::format("\n{}these records cannot tell whether {} agrees: {}\n", none, which,
                                verdict.agreement->reason);
  }
  return text;
}

}  // namespace

std::string verdict_text(const Verdict& verdict) {
  std::string text;
  for (const auto& question : verdict.questions) text += fmt::format("QUESTION  {}\n\n", question);
  if (verdict.reference) text += rows_text(*verdict.reference);
  const auto line = [&](const char* of, const ResidualFigures& f) {
    const auto position = f.position_error_rms
                              ? ", position " + rms_text(verdict.units.deviation, *f.position_error_rms, 3)
                              : std::string();
    return fmt::format("  {:<14} force {}{}\n", of, rms_text(verdict.units.force, f.force_rms, 4), position);
  };
  text += "residual on held-out data:\n" + line("machine file", verdict.baseline);
  if (!verdict.findings.empty()) text += line("extended", verdict.extended);
  if (!verdict.closed_loop_withheld.empty())
    text += fmt::format("  position error in closed loop: withheld. {}\n", verdict.closed_loop_withheld);
  text += agreement_text(verdict);
  for (std::size_t k = 0; k < verdict.findings.size(); ++k) {
    const auto& f = verdict.findings[k];
    text += fmt::format("\n{}. {}, axis {}\n", k + 1, f.effect.name(), f.axis);
    for (const auto& p : f.parameters)
      if (p.standard_errors.empty() && p.values.size() > 1) {
        const auto [least, most] = std::minmax_element(p.values.begin(), p.values.end());
        text += fmt::format("   {} = {} values from {:.6g} to {:.6g}\n", p.name(), p.values.size(), *least, *most);
      } else {
        for (std::size_t i = 0; i < p.values.size(); ++i)
          text += fmt::format("   {} = {:.6g} +- {:.2g}\n", p.name(), p.values[i],
                              i < p.standard_errors.size() ? p.standard_errors[i] : 0.0);
      }
    text += fmt::format(
        "   {}\n   held-out data: rms {} is {:.3f} times that without this cause (95 % interval {:.3f} to {:.3f})",
        f.evidence, f.residual == Residual::force ? "force" : residual_words(f.residual), gained_ratio(f),
        f.holdout.ci95[0], f.holdout.ci95[1]);
    if (f.holdout.position_error_rms_ratio)
      text += fmt::format(", position error {:.3f} times that without it", *f.holdout.position_error_rms_ratio);
    text += "\n";
    if (!f.withheld.empty()) text += fmt::format("   its keys are not in extended.toml: {}\n", f.withheld);
    for (const auto& c : f.confused_with)
      text += fmt::format("   may be {} instead; to separate them: {}\n", c.effect.name(), c.separate_by);
  }
  if (!verdict.rejected.empty()) text += "\ntried and rejected:\n";
  for (const auto& r : verdict.rejected) text += fmt::format("  {}: {}\n", r.effect.name(), r.why);
  if (verdict.unexplained.signature)
    text += fmt::format("\nunexplained: {:.1f} % of the residual variance, {}\n", 100.0 * verdict.unexplained.share,
                        *verdict.unexplained.signature);
  if (verdict.next) text += "\n" + next_measurement_text(*verdict.next) + "\n";
  for (const auto& note : verdict.notes) text += fmt::format("\nnote: {}\n", note);
  return text;
}

}  // namespace stiction::host
