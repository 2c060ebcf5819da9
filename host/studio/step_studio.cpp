#include "host/studio/step_studio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "firmware/machine/file/units.hpp"
#include "host/cam/step/project_text.hpp"
#include "host/studio/json_text.hpp"
#include "sim/cam/motion_file.hpp"

namespace stiction::host {
namespace {

using sim::cam::CamError;
namespace write = studio_json;

constexpr std::size_t most_angles = 3600;  // of a turn that are shown
// Fits nothing.
constexpr double none = std::numeric_limits<double>::quiet_NaN();

// What synthesis depends on but for relief.
std::string key_of(step::StepProject project) {
  const double lead_in = project.relief.lead_in;
  project.relief = {};
  project.relief.lead_in = lead_in;
  return project_text(project) + (project.cam ? sim::cam::motion_text({*project.cam}) : std::string());
}

// The same project, read as a file.
step::StepProject checked(const step::StepProject& project) {
  const auto text = project_text(project);
  const auto cams = [&](const std::string&) { return std::vector<sim::cam::Cam>{*project.cam}; };
  auto read = step::detail::parsed(project.name + ".toml", text, cams);
  return read;
}

std::size_t each_of(const step::StepSynthesis& made) { return (made.contacts.size() + most_angles - 1) / most_angles; }

const step::ContactForce* force_of(const step::StepForces& forces, const step::Contact& contact) {
  for (const auto& each : forces.contacts)
    if (each.contact.cam == contact.cam && each.contact.roller == contact.roller) return &each;
  return nullptr;
}

double touching(const step::ContactSet& set) {
  return static_cast<double>(std::count_if(set.contacts.begin(), set.contacts.end(),
                                           [](const auto& each) { return each.gap <= step::contact_gap; }));
}

// In the unit that the page shows.
std::optional<double> shown(const step::ProjectNumber& number, const std::optional<double>& value) {
  if (!value || number.shown.empty()) return value;
  const auto text = machine::format_quantity(*value, number.unit, number.shown);
  return std::strtod(text.c_str(), nullptr);
}

std::string number_json(const step::StepProject& project, const step::ProjectNumber& number) {
  const auto unit = number.shown.empty() ? number.unit == "1" ? std::string_view() : number.unit : number.shown;
  return fmt::format(R"({{"name":{},"group":{},"text":{},"unit":{},"value":{}}})", write::text(number.name()),
                     write::text(number.group), write::text(number.text), write::text(unit),
                     write::number(shown(number, number.get(project))));
}

std::string choice_json(const step::StepProject& project, const step::ProjectChoice& choice) {
  return fmt::format(R"({{"name":{},"group":{},"text":{},"options":{},"value":{}}})", write::text(choice.name()),
                     write::text(choice.group), write::text(choice.text), write::list(choice.options, write::text),
                     write::text(choice.get(project)));
}

std::string arc_json(const step::ReliefArc& arc) {
  return fmt::format(R"({{"cam":{},"begin":{},"end":{},"valley":{},"depth":{},"blend":{},"alone":{}}})", arc.cam,
                     write::number(step::wrapped(arc.arc.begin)),
                     write::number(step::wrapped(arc.arc.begin) + arc.arc.length()), write::truth(arc.valley),
                     write::number(arc.shape.depth), write::number(arc.shape.blend),
                     write::truth(arc.changed_at.has_value()));
}

}  // namespace

step::StepProject usual_step_project(const std::string& motion) {
  step::StepProject project;
  project.name = "step_cam";
  project.motion_file = motion;
  auto& m = project.mechanism;
  m.axis_distance = 0.105, m.arm = 0.052, m.roller_radius = 0.013, m.roller_width = 0.012, m.rollers = 4;
  m.row_angle = 0.5 * m.pitch(), m.dwell_position = 0.25 * m.pitch();
  m.hub_radius = 0.025;
  project.relief.valley.blend = project.relief.peak.blend = 4.0 * step::degree;
  project.load.inertia = 0.02;
  project.load.speed = 10.0 * std::numbers::pi;
  project.load.cam = project.load.roller = {210e9, 0.3};
  return project;
}

step::StepProject parsed_step_project(const std::string& file, const std::string& text,
                                      const std::vector<sim::cam::Cam>& cams) {
  auto project = step::detail::parsed(file, text, [&](const std::string&) { return cams; });
  if (project.spring)
    throw CamError(
        fmt::format("{}: found a single cam with a spring; expected a pair of cams: `stiction cam step` "
                    "makes single ones",
                    file));
  return project;
}

step::StepProject with_number(const step::StepProject& project, std::string_view name, std::optional<double> value) {
  for (const auto& number : step::project_numbers()) {
    if (number.name() != name) continue;
    if (value && !std::isfinite(*value)) throw CamError(fmt::format("{}: found no number; expected one", name));
    auto changed = project;
    if (value && !number.shown.empty())
      value = machine::parse_quantity(fmt::format("{} {}", *value, number.shown), number.unit);
    number.set(changed, value);
    return checked(changed);
  }
  throw CamError(fmt::format("found the key \"{}\"; expected one of the project", name));
}

step::StepProject with_choice(const step::StepProject& project, std::string_view name, std::string_view value) {
  for (const auto& choice : step::project_choices()) {
    if (choice.name() != name) continue;
    const auto& known = choice.options;
    if (!known.empty() && std::find(known.begin(), known.end(), value) == known.end())
      throw CamError(fmt::format("{}: found \"{}\"; expected one of the list", name, value));
    auto changed = project;
    choice.set(changed, value);
    return checked(changed);
  }
  throw CamError(fmt::format("found the key \"{}\"; expected one of the project", name));
}

void StepStudio::set(StepProjectPointer project, const sim::cam::Cam& cam, bool several) {
  const bool same = project == source_;
  source_ = std::move(project);
  if (!source_) {
    project_.reset(), made_.reset();
    made_of_.clear(), problem_.clear();
    return;
  }
  auto whole = *source_;
  if (!whole.measured) {
    whole.cam = cam;
    if (several || !whole.cam_name.empty()) whole.cam_name = cam.name;
  }
  auto key = key_of(whole);
  if (same && project_ && key == key_) return;
  project_ = std::move(whole);
  key_ = std::move(key);
  is_made_ = false;
}

void StepStudio::make() const {
  if (is_made_ || !project_) return;
  is_made_ = true;
  try {
    if (made_ && key_ == made_of_) {
      relieve_again(*made_, *project_);
    } else {
      made_.reset();
      made_of_ = key_;
      made_ = synthesize(*project_);
    }
    problem_.clear();
  } catch (const std::runtime_error& error) {
    problem_ = error.what();
  }
}

const step::StepSynthesis* StepStudio::made() const {
  make();
  return made_ && problem_.empty() ? &*made_ : nullptr;
}

const std::string& StepStudio::problem() const {
  make();
  return problem_;
}

step::StepProject StepStudio::relieved(const ReliefStep& change) const {
  const auto& made = required();
  if (change.arc >= made.arcs.size())
    throw CamError(fmt::format("found arc {} of {}; expected one of them", change.arc + 1, made.arcs.size()));
  const auto& arc = made.arcs[change.arc];
  auto project = *project_;
  auto& relief = project.relief;
  if (!change.alone) {
    auto& shape = arc.valley ? relief.valley : relief.peak;
    if (change.depth) shape.depth = *change.depth;
    if (change.blend) shape.blend = *change.blend;
  } else {
    const auto own = std::find_if(relief.overrides.begin(), relief.overrides.end(), [&](const auto& each) {
      return each.cam == arc.cam && arc.changed_at && each.angle == *arc.changed_at;
    });
    if (own == relief.overrides.end()) {
      const double middle = step::wrapped(arc.arc.begin + 0.5 * arc.arc.length());
      relief.overrides.push_back({.cam = arc.cam, .angle = middle, .depth = change.depth, .blend = change.blend});
    } else {
      if (change.depth) own->depth = change.depth;
      if (change.blend) own->blend = change.blend;
    }
  }
  // Refused where the arcs or the wheel do not hold it, before anything is changed.
  const auto arcs = relief_arcs(made.cut, made.couplings, relief, project.mechanism.hub_radius);
  const std::array ground{step::relieved(made.cut[0], arcs, relief.law), step::relieved(made.cut[1], arcs, relief.law)};
  step::require_wheel(project.wheel_radius, ground);
  return checked(project);
}

const step::StepSynthesis& StepStudio::required() const {
  if (!project_) throw CamError("found no step cam; expected a project");
  if (!made()) throw CamError(problem());
  return *made_;
}

std::string StepStudio::state_json() const {
  if (!project_) return "null";
  const auto& p = *project_;
  const auto& m = p.mechanism;
  std::string built = "null";
  if (const auto* of = made())
    built = fmt::format(
        R"({{"stroke":{},"turns":{},"paths":{},"mirrored":{},"axis":{},"arcs":{},"step":{},"notes":{}}})",
        write::number(of->lift.stroke()), of->count.turns, of->count.paths, write::truth(of->symmetry.holds()),
        write::number(of->symmetry.axis), write::list(of->arcs, arc_json),
        write::number(step::turn * static_cast<double>(each_of(*of)) / static_cast<double>(of->contacts.size())),
        write::list(of->notes, write::text));
  return fmt::format(
      R"({{"name":{},"motion":{},"measured":{},"problem":{},"axis_distance":{},"arm":{},"roller_radius":{},)"
      R"("hub_radius":{},"rollers":{},"pitch":{},"bases":[{},{}],"against":{},"numbers":{},"choices":{},"made":{}}})",
      write::text(p.name), write::text(p.motion_name()), write::truth(p.measured.has_value()), write::text(problem()),
      write::number(m.axis_distance), write::number(m.arm), write::number(m.roller_radius), write::number(m.hub_radius),
      m.rollers, write::number(m.pitch()), write::number(m.base(0)), write::number(m.base(1)), write::truth(m.against),
      write::list(step::project_numbers(), [&](const auto& each) { return number_json(p, each); }),
      write::list(step::project_choices(), [&](const auto& each) { return choice_json(p, each); }), built);
}

std::string StepStudio::figures_json() const {
  const auto& of = required();
  return write::list(step_figures(step_result(*project_, of)), [](const step::StepFigure& figure) {
    return fmt::format(R"({{"text":{},"value":{},"unit":{}}})", write::text(figure.text), write::text(figure.value),
                       write::text(figure.unit));
  });
}

StudioTable StepStudio::profiles() const {
  StudioTable table{4, {}};
  const auto& of = required();
  for (std::size_t cam = 0; cam < 2; ++cam) {
    const auto& cut = of.cut[cam];
    const auto& ground = of.profiles[cam];
    const auto add = [&](double angle, double before, double after) {
      table.values.insert(table.values.end(), {static_cast<double>(cam), angle, before, after});
    };
    for (std::size_t j = 0; j < cut.points.size(); ++j) {
      for (std::size_t v = 0; v < cut.vertices.size(); ++v)
        if (cut.vertices[v].behind == j) add(cut.vertices[v].angle, cut.vertices[v].radius, ground.vertices[v].radius);
      add(cut.points[j].angle, cut.points[j].radius, ground.points[j].radius);
    }
  }
  return table;
}

StudioTable StepStudio::contacts() const {
  StudioTable table{10, {}};
  const auto& of = required();
  const auto each = each_of(of);
  for (std::size_t k = 0; k * each < of.contacts.size(); ++k) {
    const auto& set = of.contacts[k * each];
    for (const auto& contact : set.contacts) {
      const auto* force = force_of(of.forces[k * each], contact);
      if (contact.gap > step::contact_gap && (force == nullptr || force->force == 0.0)) continue;
      const step::Point place = contact.place * sim::in_direction(1.0, -set.psi);
      table.values.insert(
          table.values.end(),
          {static_cast<double>(k), static_cast<double>(contact.cam), static_cast<double>(contact.roller),
           contact.needed ? 1.0 : 0.0, contact.gap, contact.pressure_angle(), force == nullptr ? 0.0 : force->force,
           force == nullptr ? 0.0 : force->pressure, place.real(), place.imag()});
    }
  }
  return table;
}

StudioTable StepStudio::turn() const {
  StudioTable table{13, {}};
  const auto& of = required();
  const auto each = each_of(of);
  const double sense = project_->mechanism.against ? -1.0 : 1.0;
  for (std::size_t k = 0; k * each < of.contacts.size(); ++k) {
    const auto& set = of.contacts[k * each];
    const auto& forces = of.forces[k * each];
    table.values.insert(table.values.end(),
                        {set.psi, sense * of.lift.at(set.psi).way, forces.output_torque, forces.input_torque,
                         forces.bearing, touching(of.unrelieved[k * each]), touching(set)});
    for (const int way : {static_cast<int>(sense), -static_cast<int>(sense)}) {
      const auto* contact = set.pushing(way);
      const auto* force = contact == nullptr ? nullptr : force_of(forces, *contact);
      table.values.insert(table.values.end(), {contact == nullptr ? none : contact->pressure_angle(),
                                               force == nullptr ? contact == nullptr ? none : 0.0 : force->force,
                                               force == nullptr ? contact == nullptr ? none : 0.0 : force->pressure});
    }
  }
  return table;
}

std::vector<step::ShopFile> StepStudio::files(const std::string& program) const {
  const auto& of = required();
  auto result = step_result(*project_, of);
  return shop_folder(result, {}, {program, project_->name});
}

}  // namespace stiction::host
