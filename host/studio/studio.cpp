#include "host/studio/studio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/cam/exchange.hpp"
#include "host/cam/shape.hpp"
#include "host/cam/step/project_text.hpp"
#include "host/simulate/cam_run.hpp"
#include "host/simulate/stand_run.hpp"
#include "host/studio/json_text.hpp"
#include "host/studio/level.hpp"
#include "host/studio/track_edit.hpp"
#include "sim/cam/edit.hpp"
#include "sim/cam/laws.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/cam/motion_keys.hpp"
#include "sim/cam/segment_table.hpp"
#include "sim/cam/shaping/methods.hpp"
#include "sim/machine_file.hpp"
#include "sim/number/sine_cosine.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

using sim::cam::Cam;
using sim::cam::CamError;
using sim::cam::Segment;

constexpr std::size_t most_steps = 200;  // of editing that can be undone
constexpr std::size_t transformed_points = 4096;
constexpr double usual_band = 0.2;  // of `stiction cam shape`

Cam empty_cam() {
  Cam cam;
  cam.name = "cam";
  cam.segments.push_back({.length = 0x1.921fb54442d18p+2, .stroke = 0.0, .law = "linear"});
  return cam;
}

Segment& segment_of(Cam& cam, std::size_t at) {
  if (at >= cam.segments.size())
    throw CamError(fmt::format("found segment {} of {}; expected one of them", at + 1, cam.segments.size()));
  return cam.segments[at];
}

Cam with_law(Cam cam, std::size_t at, std::string_view name) {
  const sim::cam::Law* law = sim::cam::find_law(name);
  if (law == nullptr) throw CamError(fmt::format("found the law \"{}\"; expected one of `stiction cam laws`", name));
  Segment& segment = segment_of(cam, at);
  segment.law = law->name;
  segment.values.clear();
  segment.points.reset();
  return cam;
}

// In two halves: a rest before, and the segment over what is left.
Cam with_rest(const Cam& cam, std::size_t at) {
  if (at >= cam.segments.size()) throw CamError("found no segment there; expected one of the list");
  return sim::cam::insert(cam, at, {.length = 0.5 * cam.segments[at].length, .stroke = 0.0, .law = "linear"});
}

Cam dragged(const Cam& cam, const Studio::Step& step) {
  Cam placed = cam;
  Segment& before = segment_of(placed, step.at);
  if (step.at + 1 < placed.segments.size()) {
    const double begin = cam.begin_of(step.at), end = cam.begin_of(step.at + 2);
    if (!(step.x > begin && step.x < end))
      throw CamError(fmt::format("found a boundary at {}; expected it between {} and {}", step.x, begin, end));
    before.length = step.x - begin;
    placed.segments[step.at + 1].length = end - step.x;
  }
  return with_level(placed, step.at, step.y);
}

Cam edited(const Cam& cam, const Studio::Step& step) {
  Cam changed = cam;
  if (step.verb == "drag") return dragged(cam, step);
  if (step.verb == "level") return with_level(cam, step.at, step.y);
  if (step.verb == "law") return with_law(cam, step.at, step.key);
  if (step.verb == "split") return sim::cam::split(cam, step.x);
  if (step.verb == "remove") return sim::cam::remove(cam, step.at);
  if (step.verb == "insert") return with_rest(cam, step.at);
  if (step.verb == "cycle") return with_cycle(cam, step.x);
  if (edits_tracks(step.verb)) return with_track(cam, {step.verb, step.at, step.key, step.x, step.y});
  if (step.verb == "start") {
    changed.start = step.x;
  } else if (step.verb == "modulo") {
    changed.modulo = step.x > 0.0 ? std::optional(step.x) : std::nullopt;
  } else if (step.verb == "value") {
    segment_of(changed, step.at).values[std::string(step.key)] = {step.x};
  } else if (step.verb == "default") {
    auto& values = segment_of(changed, step.at).values;
    if (const auto given = values.find(step.key); given != values.end()) values.erase(given);
  } else if (step.verb == "speed") {
    segment_of(changed, step.at).end.speed = step.x;
  } else if (step.verb == "free") {
    segment_of(changed, step.at).end = {};
  } else {
    throw CamError(fmt::format("found the step \"{}\"; expected one of the studio's", step.verb));
  }
  return changed;
}

// ---- JSON, which the page alone reads ----

using studio_json::list;
using studio_json::number;
std::string json_text(std::string_view text) { return studio_json::text(text); }

std::string values_json(const sim::cam::LawValues& values) {
  std::string result = "{";
  for (const auto& [key, given] : values)
    if (given.size() == 1)
      result += fmt::format("{}{}:{}", result.size() > 1 ? "," : "", json_text(key), number(given[0]));
  return result + "}";
}

std::string parameter_json(const machine::ValueKey& key) {
  return fmt::format(R"({{"key":{},"least":{},"most":{},"default":{},"text":{},"list":{}}})", json_text(key.key),
                     number(key.range.low), number(key.range.high), number(key.fallback), json_text(key.text),
                     key.list ? "true" : "false");
}

std::string law_json(const sim::cam::Law& law) {
  return fmt::format(R"({{"number":{},"name":{},"task":{},"kind":{},"english":{},"formula":{},"parameters":{}}})",
                     law.number, json_text(law.name), json_text(task_of(law)), json_text(sim::cam::name_of(law.kind)),
                     json_text(law.english), json_text(law.formula), list(law.parameters, parameter_json));
}

std::string segment_json(const Cam& cam, std::size_t k) {
  const Segment& segment = cam.segments[k];
  return fmt::format(R"({{"begin":{},"length":{},"from":{},"stroke":{},"rise":{},"law":{},"values":{},"speed":{},)"
                     R"("acceleration":{},"jerk":{}}})",
                     number(cam.begin_of(k)), number(segment.length), number(cam.position_of(k)),
                     number(segment.stroke), number(segment.rise()), json_text(segment.law),
                     values_json(segment.values), number(segment.end.speed), number(segment.end.acceleration),
                     number(segment.end.jerk));
}

std::string track_json(const sim::cam::Track& track) {
  const auto window = [](const sim::cam::Track::Window& each) {
    return fmt::format("[{},{}]", number(each.first), number(each.last));
  };
  return fmt::format(R"({{"name":{},"windows":{},"on":{},"off":{},"hysteresis":{}}})", json_text(track.name),
                     list(track.windows, window), number(track.on_compensation), number(track.off_compensation),
                     number(track.hysteresis));
}

std::string jump_json(const sim::cam::MotionJump& found) {
  return fmt::format(R"({{"place":{},"order":{},"height":{},"where":{},"segment":{},"share":{}}})",
                     number(found.jump.place), found.jump.order, number(found.jump.height),
                     json_text(name_of(found.where)), found.segment, number(found.share));
}

std::string limit_json(const Limit& limit) {
  return fmt::format(R"({{"name":{},"unit":{},"found":{},"allowed":{},"place":{},"highest_speed":{},"broken":{}}})",
                     json_text(limit.name), json_text(limit.unit), number(limit.found), number(limit.allowed),
                     number(limit.place), number(limit.highest_speed), limit.broken() ? "true" : "false");
}

// Of the shaft, in the axis' own unit: N m/rad or N/m.
std::optional<double> stiffness_of(const machine::AxisModel& axis) {
  if (!axis.transmission || !axis.transmission->stiffness) return std::nullopt;
  const double radius = axis.coordinate.rotary() ? axis.coordinate.radius : 1.0;
  return *axis.transmission->stiffness * radius * radius;
}

// ---- runs ----

// Of the deviations in `ticks`, whose second column they are.
void count_errors(StudioRun& run) {
  const auto& table = run.ticks;
  double sum = 0.0;
  for (std::size_t i = 1; i < table.values.size(); i += table.columns) {
    const double error = std::fabs(table.values[i]);
    run.peak_error = std::max(run.peak_error, error);
    sum += error;
  }
  if (!table.values.empty()) run.mean_error = sum / static_cast<double>(table.values.size() / table.columns);
}

void add_row(StudioTable& table, double a, double b, double c) {
  table.columns = 3;
  table.values.insert(table.values.end(), {a, b, c});
}

void add_record(StudioTable& table, const AxisLog& axis) {
  table.columns = 4;
  for (std::size_t k = 0; k < axis.x.size(); ++k)
    table.values.insert(table.values.end(), {axis.master[k], axis.x_set[k], axis.x[k], axis.v[k]});
}

}  // namespace

Studio::Studio() : cams_{empty_cam()}, motion_(compose(cams_.front())) {}

void Studio::load_motion(const std::string& file, const std::string& text) {
  auto cams = sim::cam::parse_motion_file(file, text);
  std::size_t edited = 0;
  const std::string wanted = step_project_ ? step_project_->cam_name : std::string();
  for (std::size_t k = 0; k < cams.size(); ++k)
    if (cams[k].name == wanted) edited = k;
  auto motion = compose(cams[edited]);
  begin_step(false);
  cams_ = std::move(cams), motion_ = std::move(motion), edited_ = edited;
  motion_file_ = file;
  if (!step_project_) return;
  auto project = *step_project_;
  project.motion_file = file;
  step_project_ = std::make_shared<const step::StepProject>(std::move(project));
}

void Studio::choose_cam(std::size_t at) {
  if (at >= cams_.size()) throw CamError(fmt::format("found cam {} of {}; expected one of them", at + 1, cams_.size()));
  auto motion = compose(cams_[at]);
  begin_step(false);
  motion_ = std::move(motion), edited_ = at;
}

void Studio::load_step(const std::string& file, const std::string& text) {
  auto project = parsed_step_project(file, text, cams_);
  std::size_t edited = edited_;
  for (std::size_t k = 0; k < cams_.size(); ++k)
    if (project.cam && cams_[k].name == project.cam->name) edited = k;
  auto motion = compose(cams_[edited]);
  begin_step(false);
  motion_ = std::move(motion), edited_ = edited;
  step_project_ = std::make_shared<const step::StepProject>(std::move(project));
}

void Studio::new_step() {
  auto project = usual_step_project(motion_file_);
  project.cam = cam();
  keep_step(std::move(project), false);
}

std::string Studio::step_text() const {
  const auto* project = step().project();
  if (project == nullptr) throw CamError("found no step cam; expected a project");
  return step::project_text(*project);
}

const StepStudio& Studio::step() const {
  step_.set(step_project_, cam(), cams_.size() > 1);
  return step_;
}

void Studio::set_step_number(std::string_view name, std::optional<double> value) {
  if (step().project() == nullptr) throw CamError("found no step cam; expected a project");
  keep_step(with_number(*step_.project(), name, value), false);
}

void Studio::set_step_choice(std::string_view name, std::string_view value) {
  if (step().project() == nullptr) throw CamError("found no step cam; expected a project");
  keep_step(with_choice(*step_.project(), name, value), false);
}

void Studio::set_relief(const ReliefStep& change, bool goes_on) { keep_step(step().relieved(change), goes_on); }

std::string Studio::motion_text() const { return sim::cam::motion_text(cams_); }

void Studio::load_machine(const std::string& file, const std::string& text, const std::string& axis) {
  auto read = sim::parse_machine(file, text);
  const bool rotary = cam().slave == sim::cam::Coordinate::rotary;
  const auto fits = [&](const machine::AxisModel& each) {
    return axis.empty() ? each.coordinate.rotary() == rotary : each.name == axis;
  };
  const auto found = std::find_if(read.axes.begin(), read.axes.end(), fits);
  if (found == read.axes.end())
    throw CamError(fmt::format("{}: found no {} axis{}; expected one that the cam {} can drive", file,
                               rotary ? "rotary" : "linear", axis.empty() ? "" : " " + axis, cam().name));
  auto kept = std::move(*found);
  read.axes.clear();
  read.axes.push_back(std::move(kept));
  load_ = load_of(read.axes.front());
  machine_ = std::move(read);
}

std::string Studio::exported_file(std::string_view format) const {
  if (format != "table") return exported(motion_, exchange_format(format), {});
  const auto table = sim::cam::table_within(motion_, sim::cam::table_tolerance(motion_));
  return {table.bytes.begin(), table.bytes.end()};
}

Studio::Version Studio::version() { return {cams_, motion_, edited_, step_project_}; }

void Studio::restore(Version version) {
  cams_ = std::move(version.cams), motion_ = std::move(version.motion);
  edited_ = version.edited, step_project_ = std::move(version.step);
}

void Studio::begin_step(bool goes_on) {
  if (!goes_on || past_.empty()) {
    past_.push_back(version());
    if (past_.size() > most_steps) past_.erase(past_.begin());
  }
  future_.clear();
}

void Studio::keep(Cam cam, bool goes_on) {
  auto motion = compose(cam);
  begin_step(goes_on);
  cams_[edited_] = std::move(cam);
  motion_ = std::move(motion);
}

void Studio::keep_step(step::StepProject project, bool goes_on) {
  begin_step(goes_on);
  step_project_ = std::make_shared<const step::StepProject>(std::move(project));
}

void Studio::edit(const Step& step) { keep(edited(cam(), step), step.goes_on); }

void Studio::shape(std::string_view method, double speed) {
  const auto* found = sim::cam::find_shaping_method(method);
  if (found == nullptr) throw CamError(fmt::format("found the method \"{}\"; expected one of the list", method));
  const auto& axis = required_machine().axes.front();
  if (!axis.elastic()) throw CamError("found an axis without an elastic shaft; expected one whose load vibrates");
  auto task = shaping_task(motion_, sim::cam::elastic_drive_of(axis), speed, usual_band, {});
  task.limits = limits_of(load_, task.stroke, task.rise_time());
  auto made = sim::cam::shaped(task, *found);
  if (!made) throw CamError(fmt::format("found no room for the method {}; expected a longer rise or dwell", method));
  keep(std::move(made->cam), false);
}

bool Studio::undo() {
  if (past_.empty()) return false;
  future_.push_back(version());
  restore(std::move(past_.back()));
  past_.pop_back();
  return true;
}

bool Studio::redo() {
  if (future_.empty()) return false;
  past_.push_back(version());
  restore(std::move(future_.back()));
  future_.pop_back();
  return true;
}

std::string Studio::state_json(double speed) const {
  const Cam& c = cam();
  std::vector<std::size_t> numbers(c.segments.size());
  for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = k;
  const auto duty = machine_ ? duty_of(motion_, load_, speed) : duty_of(motion_, speed);
  std::string machine = "null";
  if (machine_)
    machine = fmt::format(
        R"({{"id":{},"name":{},"axis":{},"effort_unit":{},"effort":{},"frequency":{},"stiffness":{},"elastic":{},"fixed":{}}})",
        json_text(machine_->id), json_text(machine_->name), json_text(load_.axis), json_text(load_.effort_unit()),
        number(load_.largest_effort), number(load_.frequency), number(stiffness_of(machine_->axes.front())),
        machine_->axes.front().elastic() ? "true" : "false",
        machine_->axes.front().cascaded() && machine_->fits_formats() ? "true" : "false");
  const auto& e = duty.effort;
  return fmt::format(
      R"({{"name":{},"cams":{},"edited":{},"step":{},"master":{},"slave":{},"cycle":{},"periodic":{},"start":{},"modulo":{},"segments":{},)"
      R"("tracks":{},"undo":{},"redo":{},"jumps":{},"limits":{},"speed_peak":{},"acceleration_peak":{},)"
      R"("motor":{},"motor_rms":{},"load_effort":{},"classic":{},"machine":{}}})",
      json_text(c.name), list(cams_, [](const Cam& each) { return json_text(each.name); }), edited_,
      step_project_ ? "true" : "false", json_text(sim::cam::name_of(c.master)), json_text(sim::cam::name_of(c.slave)),
      number(c.cycle()), c.periodic ? "true" : "false", number(c.start), number(c.modulo),
      list(numbers, [&](std::size_t k) { return segment_json(c, k); }), list(c.tracks, track_json), past_.size(),
      future_.size(), list(jumps_of(motion_), jump_json), list(duty.limits, limit_json),
      number(duty.extremes[1].magnitude()), number(duty.extremes[2].magnitude()), number(std::fabs(e.motor.value)),
      number(e.motor_rms), number(std::fabs(e.load.value)), number(std::fabs(e.cam.value)), machine);
}

std::string Studio::methods_json() {
  return list(sim::cam::shaping_methods(), [](const sim::cam::ShapingMethod& method) {
    return fmt::format(R"({{"name":{},"label":{},"needs":{}}})", json_text(method.name), json_text(method.label),
                       json_text(method.needs));
  });
}

std::string Studio::formats_json() {
  return list(exchange_formats(), [](const ExchangeFormat& format) {
    return fmt::format(R"({{"name":{},"text":{}}})", json_text(format.name), json_text(format.text));
  });
}

std::string Studio::laws_json() { return list(sim::cam::laws(), law_json); }

StudioTable Studio::law_curve(std::size_t k) {
  StudioTable table{2, {}};
  const auto curve = sim::cam::unit_curve(sim::cam::laws().at(k));
  for (int i = 0; i <= 40; ++i) {
    const double x = i / 40.0;
    table.values.insert(table.values.end(), {x, curve(x)});
  }
  return table;
}

StudioTable Studio::curves(double speed, std::size_t points) const {
  StudioTable table{7, {}};
  for (const auto& piece : motion_.curve.pieces()) {
    const auto share = static_cast<double>(points) * piece.length() / motion_.curve.length();
    const int count = std::max(8, static_cast<int>(share));
    for (int k = 0; k <= count; ++k) {
      const double x = k == count ? piece.end : piece.begin + piece.length() * k / count;
      const double y = piece.derivative(x, 0), v = piece.derivative(x, 1), a = piece.derivative(x, 2);
      const double effort = machine_ ? load_.effort(y, v * speed, a * speed * speed) : 0.0;
      table.values.insert(table.values.end(), {x, y, v, a, piece.derivative(x, 3), v * a, effort});
    }
  }
  return table;
}

std::vector<double> Studio::harmonics(std::size_t count) const {
  std::vector<double> samples(transformed_points), amplitudes;
  const auto& curve = motion_.curve;
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k] = curve.derivative(
        curve.begin() + curve.length() * static_cast<double>(k) / static_cast<double>(transformed_points), 2);
  for (std::size_t h = 1; h <= count; ++h) {
    double real = 0.0, imaginary = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const auto turn = static_cast<double>(h * k % transformed_points) / static_cast<double>(transformed_points);
      const auto [s, c] = sim::sine_cosine(turn * 0x1.921fb54442d18p+2);
      real += samples[k] * c, imaginary += samples[k] * s;
    }
    amplitudes.push_back(2.0 * std::sqrt(real * real + imaginary * imaginary) /
                         static_cast<double>(transformed_points));
  }
  return amplitudes;
}

const machine::Machine& Studio::required_machine() const {
  if (!machine_) throw CamError("found no machine; expected a machine file");
  const auto& axis = machine_->axes.front();
  if (!axis.cascaded() || !machine_->fits_formats())
    throw CamError(
        fmt::format("found axis {} of {}; expected one that the drive's number formats and its cascade hold: "
                    "`stiction simulate cam` runs it in double precision",
                    axis.name, machine_->id));
  return *machine_;
}

StudioRun Studio::follow(double speed, int cycles) const {
  const auto& machine = required_machine();
  const auto run = run_cam<FixedSignals>(machine, motion_, {.master_speed = speed, .cycles = cycles});
  StudioRun result;
  result.peak_error = run.error.peak, result.mean_error = run.error.mean;
  result.peak_effort = run.peak_effort, result.rms_effort = run.rms_effort;
  const auto& axis = run.log.axes.front();
  for (std::size_t k = 0; k < run.master.size(); ++k)
    add_row(result.ticks, run.master[k], run.following[k], run.effort[k]);
  add_record(result.record, axis);
  return result;
}

StudioRun Studio::stand(double speed, int cycles, double stiffness) const {
  auto machine = required_machine();
  auto& axis = machine.axes.front();
  if (axis.transmission && axis.transmission->stiffness) *axis.transmission->stiffness *= stiffness;
  const auto run = run_stand<FixedSignals>(machine, motion_, {.master_speed = speed, .cycles = cycles});
  StudioRun result;
  const auto& curve = motion_.curve;
  const double cycle = curve.length(),
               rise = curve.derivative(curve.end(), 0, sim::cam::Side::left) - curve(curve.begin());
  for (const auto& state : run.load) {
    const double gone = std::floor(state.master / cycle), place = state.master - cycle * gone;
    if (static_cast<int>(gone) + 1 == cycles)
      add_row(result.ticks, place, curve(place) + rise * gone - state.position, 0.0);
  }
  count_errors(result);
  add_record(result.record, run.log.axes.front());
  result.motor_error = run.motor_error;
  if (const auto dwell = sim::cam::longest_dwell(motion_)) {
    const auto figures = dwell_figures(run.load, motion_, *dwell);
    result.dwell = figures.peak_to_peak, result.dwell_area = figures.quality;
  }
  return result;
}

}  // namespace stiction::host
