// The page of a step cam: see step_cam_report.hpp.
#include "host/report/step_cam_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/report/assets.hpp"
#include "host/report/chart_json.hpp"
#include "host/report/page.hpp"
#include "host/report/page_data.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

// Of a turn that are shown.
constexpr std::size_t most_angles = 1800;

std::string base64_of(const std::vector<float>& values) { return base64_floats(values); }
float single(double value) { return static_cast<float>(value); }

// The angles of the cam that the page shows: every so many of the synthesis.
struct ShownAngles {
  std::size_t each = 1, count = 0;

  explicit ShownAngles(const step::StepSynthesis& made)
      : each((made.contacts.size() + most_angles - 1) / most_angles), count(made.contacts.size() / each) {}
};

const step::ContactForce* force_of(const step::StepForces& forces, const step::Contact& contact) {
  const auto found = std::find_if(forces.contacts.begin(), forces.contacts.end(), [&](const auto& each) {
    return each.contact.cam == contact.cam && each.contact.roller == contact.roller;
  });
  return found == forces.contacts.end() ? nullptr : &*found;
}

// The contacts of every shown angle, nine numbers each, in the order of step_cam.js: index of the angle, cam, roller,
// needed, gap in um, pressure angle in deg, force in N, pressure in MPa, place in mm in the frame that rests.
std::string contacts_text(const step::StepSynthesis& made, const ShownAngles& shown) {
  std::vector<float> all;
  for (std::size_t k = 0; k < shown.count; ++k) {
    const auto& set = made.contacts[k * shown.each];
    for (const auto& contact : set.contacts) {
      const auto* force = force_of(made.forces[k * shown.each], contact);
      if (contact.gap > step::contact_gap && (force == nullptr || force->force == 0.0)) continue;
      const step::Point place = contact.place * std::polar(1e3, -set.psi);
      for (const double value :
           {static_cast<double>(k), contact.cam + 1.0, contact.roller + 1.0, contact.needed ? 1.0 : 0.0,
            1e6 * contact.gap, contact.pressure_angle() / step::degree, force == nullptr ? 0.0 : force->force,
            force == nullptr ? 0.0 : 1e-6 * force->pressure, place.real(), place.imag()})
        all.push_back(single(value));
    }
  }
  return base64_of(all);
}

json profile_json(const step::StepProfile& profile) {
  const std::size_t each = (profile.points.size() + most_angles - 1) / most_angles;
  std::vector<float> x, y;
  const auto add = [&](step::Point place) {
    x.push_back(single(1e3 * place.real())), y.push_back(single(1e3 * place.imag()));
  };
  for (std::size_t j = 0; j < profile.points.size(); ++j) {
    for (const auto& vertex : profile.vertices)
      if (vertex.behind == j) add(vertex.place());
    if (j % each == 0) add(profile.points[j].place());
  }
  return {{"x", base64_of(x)}, {"y", base64_of(y)}};
}

json mechanism_json(const StepCamReport& report, const ShownAngles& shown) {
  const auto& m = report.project.mechanism;
  std::vector<float> turned;
  for (std::size_t k = 0; k < shown.count; ++k)
    turned.push_back(single((m.against ? -1.0 : 1.0) *
                            report.made.lift.at(report.made.contacts[k * shown.each].psi).way / step::degree));
  return {
      {"axis_distance_mm", rounded(1e3 * m.axis_distance)},
      {"arm_mm", rounded(1e3 * m.arm)},
      {"roller_radius_mm", rounded(1e3 * m.roller_radius)},
      {"hub_radius_mm", rounded(1e3 * m.hub_radius)},
      {"rollers", m.rollers},
      {"bases_deg", {rounded(m.base(0) / step::degree), rounded(m.base(1) / step::degree)}},
      {"pitch_deg", rounded(m.pitch() / step::degree)},
      {"step_deg", rounded(360.0 * static_cast<double>(shown.each) / static_cast<double>(report.made.contacts.size()))},
      {"turned_deg", base64_of(turned)},
      {"profiles", {profile_json(report.made.profiles[0]), profile_json(report.made.profiles[1])}},
      {"contacts", contacts_text(report.made, shown)}};
}

// ---- charts ----

sim::Chart chart(const char* title, const char* y_label, const char* caption) {
  sim::Chart chart{.title = title, .x_label = "cam angle, °", .y_label = y_label, .caption = caption, .series = {}};
  chart.x_range = {{0.0, 360.0}};
  chart.shape = {true, sim::Shape::Height::low};
  return chart;
}

// One value of the needed contacts that push the carousel on and hold it back, over a turn.
template <class Value>
std::vector<sim::Series> of_needed(const StepCamReport& report, const ShownAngles& shown, Value value) {
  const int on = report.project.mechanism.against ? -1 : 1;
  std::vector<sim::Series> both{{.name = "pushes the carousel on", .x = {}, .y = {}},
                                {.name = "holds it back", .x = {}, .y = {}}};
  for (std::size_t k = 0; k < shown.count; ++k) {
    const auto& set = report.made.contacts[k * shown.each];
    for (const int way : {on, -on}) {
      const auto* contact = set.pushing(way);
      if (contact == nullptr) continue;
      auto& series = both[way == on ? 0 : 1];
      series.x.push_back(set.psi / step::degree);
      series.y.push_back(value(*contact, force_of(report.made.forces[k * shown.each], *contact)));
    }
  }
  return both;
}

sim::Series touching(const char* name, const std::vector<step::ContactSet>& sets, const ShownAngles& shown) {
  sim::Series series{.name = name, .x = {}, .y = {}};
  for (std::size_t k = 0; k < shown.count; ++k) {
    const auto& set = sets[k * shown.each];
    series.x.push_back(set.psi / step::degree);
    series.y.push_back(static_cast<double>(std::count_if(
        set.contacts.begin(), set.contacts.end(), [](const auto& each) { return each.gap <= step::contact_gap; })));
  }
  return series;
}

std::vector<sim::Chart> charts_of(const StepCamReport& report, const ShownAngles& shown) {
  using Contact = const step::Contact&;
  using Force = const step::ContactForce*;
  std::vector<sim::Chart> charts{
      chart("Pressure angle", "pressure angle, °", "Of the two contacts that the carousel needs."),
      chart("Contact force", "contact force, N",
            "Of the same contacts at the project's speed; each jump hands over to a "
            "different roller."),
      chart("Hertz pressure", "Hertz pressure, MPa", "Of a line contact over the roller's width."),
      chart("Rollers that touch", "rollers, 1", "Within 1.5 µm of both profiles.")};
  charts[0].series =
      of_needed(report, shown, [](Contact contact, Force) { return contact.pressure_angle() / step::degree; });
  charts[1].series =
      of_needed(report, shown, [](Contact, Force force) { return force == nullptr ? 0.0 : force->force; });
  charts[2].series =
      of_needed(report, shown, [](Contact, Force force) { return force == nullptr ? 0.0 : 1e-6 * force->pressure; });
  charts[3].series = {touching("before relief", report.made.unrelieved, shown),
                      touching("after relief", report.made.contacts, shown)};
  charts[3].y_range = {{0.0, 4.0}};
  charts[3].y_step = 1.0;
  return charts;
}

// ---- what it was made of ----

json section(const char* title, std::initializer_list<std::array<std::string, 3>> rows) {
  json list = json::array();
  for (const auto& [label, value, unit] : rows)
    list.push_back({{"label", label}, {"unit", unit}, {"values", json::array({value})}});
  return {{"title", title}, {"columns", json::array({""})}, {"rows", list}};
}

// The project as the sheet of a machine, for machine.js.
json sheet_json(const StepCamReport& report) {
  const auto& p = report.project;
  const auto& m = p.mechanism;
  const auto& t = p.tolerances;
  const auto text = [](double value) { return fmt::format("{:.6g}", value); };
  const auto relief = [&](const step::ReliefShape& shape) {
    return fmt::format("{:.4g} mm, blends {:.4g}°", 1e3 * shape.depth, shape.blend / step::degree);
  };
  return {{"name", "Step cam " + p.name},
          {"id", p.name},
          {"axes", json::array()},
          {"sections",
           {section("Mechanism",
                    {{"axis distance", text(1e3 * m.axis_distance), "mm"},
                     {"arm", text(1e3 * m.arm), "mm"},
                     {"roller radius", text(1e3 * m.roller_radius), "mm"},
                     {"roller width", text(1e3 * m.roller_width), "mm"},
                     {"rollers of a row", text(m.rollers), ""},
                     {"angle between the rows", text(m.row_angle / step::degree), "°"},
                     {"rollers at rest", text(m.dwell_position / step::degree), "°"},
                     {"hub radius", text(1e3 * m.hub_radius), "mm"},
                     {"grinding wheel", p.wheel_radius > 0.0 ? text(1e3 * p.wheel_radius) : "not stated", "mm"}}),
            section("Load", {{"inertia", text(p.load.inertia), "kg m²"},
                             {"torque", text(p.load.torque), "N m"},
                             {"speed of the cam", text(p.load.speed * 60.0 / step::turn), "r/min"},
                             {"preload", text(1e6 * p.load.preload), "µm"},
                             {"stiffness of a contact",
                              p.load.stiffness > 0.0 ? text(1e-6 * p.load.stiffness) : "rigid", "N/µm"}}),
            section("Relief", {{"valleys", relief(p.relief.valley), ""},
                               {"peaks", relief(p.relief.peak), ""},
                               {"lead-in", text(p.relief.lead_in / step::degree), "°"},
                               {"law of the blends", p.relief.law, ""}}),
            section("Tolerances", {{"axis distance", "±" + text(1e6 * t.axis_distance), "µm"},
                                   {"roller radius", "±" + text(1e6 * t.roller), "µm"},
                                   {"arm", "±" + text(1e6 * t.arm), "µm"},
                                   {"profile", "±" + text(1e6 * t.profile), "µm"},
                                   {"preload", "±" + text(1e6 * t.preload), "µm"}})}}};
}

json conditions_json(const StepCamReport& report) {
  const auto& made = report.made;
  Conditions conditions;
  conditions.add("Step", fmt::format("{:.6g}° in a turn of the cam", made.lift.stroke() / step::degree));
  conditions.add("Rollers", fmt::format("{} in each of two rows", report.project.mechanism.rollers));
  conditions.add("Carousel is back", fmt::format("after {} turns of the cam", made.count.turns));
  conditions.add("Cams", made.symmetry.holds()
                             ? fmt::format("mirrored about {:.4g}°, the zero pin", made.symmetry.axis / step::degree)
                             : std::string("two profiles"));
  return conditions.json();
}

std::string sentence(const StepCamReport& report) {
  const auto after = report.made.shares(report.made.contacts), before = report.made.shares(report.made.unrelieved);
  return fmt::format("Exactly two rollers touch in {:.1f} % of the turn after relief, in {:.1f} % before it.",
                     100.0 * after.two, 100.0 * before.two);
}

}  // namespace

std::string step_cam_report_html(const StepCamReport& report) {
  const ShownAngles shown(report.made);
  const auto list = charts_of(report, shown);
  json charts = json::array(), figures = json::array();
  for (const auto& each : list) charts.push_back(chart_json(each, "charts", "turn"));
  for (const auto& each : report.figures)
    figures.push_back({{"text", each.text}, {"value", each.value}, {"unit", each.unit}});
  const json data{{"schema", "stiction.step-cam-report/1"},
                  {"conditions", conditions_json(report)},
                  {"series", series_json(list)},
                  {"charts", charts},
                  {"figures", figures},
                  {"notes", report.made.notes},
                  {"mechanism", mechanism_json(report, shown)},
                  {"machine", sheet_json(report)}};
  return report_page({"Step cam", "Step cam: " + report.project.name, sentence(report), report.command, report.version,
                      report.project.name, report.origin},
                     assets::step_cam_html(), {}, data, {assets::charts_js(), assets::step_cam_js()});
}

}  // namespace stiction::host
