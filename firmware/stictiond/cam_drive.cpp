#include "firmware/stictiond/cam_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "firmware/machine/configuration/cam_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/file/units.hpp"
#include "firmware/stictiond/table_range.hpp"
#include "hal/can/encoder.hpp"
#include "stiction/motion/cam_words.hpp"

namespace stiction::drive {
namespace {

constexpr const char* kind_names[]{"linear", "rotary"};
const char* name_of(CamTable::Kind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

[[noreturn]] void refuse_table(const std::string& file, const std::string& problem) {
  throw StartRefused(fmt::format("--cam: {}: {}. Nothing is enabled (fault {} '{}')", file, problem,
                                 static_cast<int>(Fault::cam_table), stiction::name_of(Fault::cam_table)));
}

double metres(std::int64_t raw) { return std::ldexp(static_cast<double>(raw), -MotionPoint::position_bits); }

}  // namespace

CamDrive::CamDrive(const DriveOptions& options, const DriveConfiguration& configuration) {
  if (options.hold && options.master != "virtual")
    throw StartRefused(fmt::format(
        "--hold: found --master {}; expected virtual, as clients alone move the axes otherwise", options.master));
  if (options.speed.empty())
    throw StartRefused("--master: found no --speed; expected the largest speed of the master, such as \"130 rpm\"");
  find_master(options, configuration);
  for (const auto& file : options.cam) load(file);
  set_up_master(options, configuration);
  const bool serves = !options.hold;
  set_up_axes(configuration, serves);
  set_up_tracks(configuration);
  if (tables_.empty() && !serves)
    throw StartRefused("--hold: found --master without --cam; expected a table to follow, or no --hold");
  if (!tables_.empty()) check_limits(configuration, serves);
  if (configuration.setup.cam_tuning) set_up_tuning(configuration, serves);
}

void CamDrive::find_master(const DriveOptions& options, const DriveConfiguration& configuration) {
  const auto& names = configuration.names;
  if (options.master == "virtual") return;
  constexpr std::string_view can = "can:";
  if (options.master.starts_with(can)) {
    const char* const end = options.master.data() + options.master.size();
    const auto [rest, error] = std::from_chars(options.master.data() + can.size(), end, encoder_node_);
    if (error != std::errc{} || rest != end || encoder_node_ < 1 || encoder_node_ > hal::can::highest_node)
      throw StartRefused(fmt::format("--master: found '{}'; expected can:NODE with a node from 1 to {}", options.master,
                                     hal::can::highest_node));
    return;
  }
  const auto found = std::find(names.begin(), names.end(), options.master);
  if (found == names.end())
    throw StartRefused(fmt::format("--master: found '{}'; expected virtual, an axis of {}, or can:NODE", options.master,
                                   configuration.machine.id));
  master_axis_ = static_cast<std::size_t>(found - names.begin());
  master_kind_ = CamTable::Kind::linear;
  if (names.size() < 2)
    throw StartRefused("--master: found the only axis of the machine; expected virtual, or a second axis that follows");
}

void CamDrive::set_up_encoder(const DriveConfiguration& configuration, CamMaster::Config& config) {
  const auto& setup = configuration.setup;
  const std::string of = configuration.machine.id + ": [drive.master_encoder]";
  if (!setup.master_encoder)
    throw StartRefused(
        fmt::format("{}: found no such table, and --master can:{}; expected one with the interface and "
                    "the counts of the encoder",
                    of, encoder_node_));
  const auto& encoder = *setup.master_encoder;
  if (setup.can && setup.can->interface == encoder.interface)
    throw StartRefused(
        fmt::format("{}: found the interface of [drive.can], {}; expected a different one, as that bus is "
                    "for power stages alone",
                    of, encoder.interface));
  const auto own = [&](const auto& axis) { return axis.second.server_node == encoder_node_; };
  if (setup.can_server && setup.can_server->interface == encoder.interface &&
      std::any_of(setup.axes.begin(), setup.axes.end(), own))
    throw StartRefused(
        fmt::format("--master: found can:{}, the server_node of an axis on {}; expected a node of its own",
                    encoder_node_, encoder.interface));
  const bool rotary = master_kind_ == CamTable::Kind::rotary;
  if (rotary ? encoder.counts_per_turn == 0.0 : !encoder.position_increment)
    throw StartRefused(fmt::format("{}: found no {}; expected it, as the master is {}", of,
                                   rotary ? "counts_per_turn" : "position_increment", name_of(master_kind_)));
  const double counts =
      rotary ? encoder.counts_per_turn * cycle_ / (2.0 * std::numbers::pi) : cycle_ / *encoder.position_increment;
  // Rounded in the table to 2^-40 rad or m.
  if (std::abs(counts - std::round(counts)) > 1e-6 || counts < 4.0 ||
      counts > static_cast<double>(MasterEncoder::longest_cycle))
    throw StartRefused(
        fmt::format("{}: found {:.10g} counts in a cycle of the master; expected a whole number of them, "
                    "4 to 2^40, so that nothing drifts",
                    of, counts));
  const double period = configuration.machine.timing.fast_period, ticks = encoder.period / period;
  const auto in_ticks = [](double t) { return std::llround(std::ldexp(t, MasterEncoder::time_bits)); };
  MasterEncoder::Config made;
  made.range = std::llround(encoder.range);
  made.cycle = std::llround(counts);
  made.period = in_ticks(std::max(ticks, 1.0));
  made.patience = 3 * made.period + (std::int64_t{1} << MasterEncoder::time_bits);
  // At twice the largest speed, and some counts.
  const double most = 2.0 * speed_ * encoder.period * counts + 4.0;
  if (most > std::min(0.5 * encoder.range, 0x1p30))
    throw StartRefused(
        fmt::format("--speed: found {:.6g} counts in two periods of the encoder; expected at most half of "
                    "drive.master_encoder.range, and 2^30",
                    most));
  made.most = std::llround(most);
  encoder_.emplace(made);
  ticks_a_ns_ = 1e-9 / period;
  config.measured = true;
  config.cycle = Span::of(made.cycle << MasterEncoder::part_bits);
  // Over four positions, so that little of their steps is left.
  config.estimator.bits =
      std::clamp(static_cast<int>(std::ceil(std::log2(4.0 * ticks))), 3, MasterEstimator::most_bits);
  config.estimator.half_count = std::llround(0x1p63 / counts);
  config.estimator.jump = std::int64_t{1} << 58;
  config.estimator.look_ahead = static_cast<std::int32_t>(made.period + in_ticks(encoder.delay / period));
}

void CamDrive::take(const hal::can::Frame& frame, std::int64_t age_ns) {
  if (!encoder_) return;
  if (const auto broken = hal::can::encoder_error_of(frame, encoder_node_)) encoder_->say(*broken);
  const auto position = hal::can::encoder_position_of(frame, encoder_node_);
  if (!position) return;
  const double age = static_cast<double>(std::clamp<std::int64_t>(age_ns, 0, 1'000'000'000)) * ticks_a_ns_;
  encoder_->take(*position, std::llround(std::ldexp(age, MasterEncoder::time_bits)));
}

void CamDrive::load(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw StartRefused(fmt::format("--cam: {}: found no file that can be read; expected a table", file));
  auto& loaded = loaded_.emplace_back();
  constexpr std::size_t most = CamTable::header_size + CamTable::segment_size * CamTable::most_segments + 1'600'000;
  std::vector<char> text(most + 1);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  loaded.bytes.assign(text.begin(), text.begin() + stream.gcount());
  if (const auto problem = CamTable::read(loaded.bytes, loaded.table); problem != CamTableProblem::none)
    refuse_table(file, fmt::format("found {}; expected one as `stiction cam table` makes it", words_of(problem)));
  check_kinds(file, loaded.table.header());
  CamMode::Table made;
  CamCurve::Config config;
  config.table = &loaded.table;
  config.periodic = loaded.table.header().periodic;
  if (const auto refusal = CamCurve::prepare(config, made.curve); refusal != CamRefusal::none)
    refuse_table(file, fmt::format("found {}; expected a curve that an axis can follow", words_of(refusal)));
  find_range(loaded.table, made);
  tables_.push_back(made);
  files_.push_back(file);
}

void CamDrive::check_kinds(const std::string& file, const CamTable::Header& header) const {
  if (header.slave != CamTable::Kind::linear)
    refuse_table(file, "found a table for a rotary axis; expected one for a linear axis, as those of the drive are");
  if (master_axis_ && header.master != CamTable::Kind::linear)
    refuse_table(file, "found a table behind a rotary master; expected a linear one, as the axis of --master is");
  if (loaded_.size() < 2) return;
  const auto& first = loaded_.front().table.header();
  if (header.master != first.master || header.cycle != first.cycle)
    refuse_table(file,
                 fmt::format("found a cycle of {:.6g} of a {} master; expected that of {}, {:.6g} of a {} one, as "
                             "both have one master",
                             metres(header.cycle), name_of(header.master), files_.front(), metres(first.cycle),
                             name_of(first.master)));
}

void CamDrive::set_up_master(const DriveOptions& options, const DriveConfiguration& configuration) {
  if (!loaded_.empty()) {
    master_kind_ = loaded_.front().table.header().master;
    cycle_ = metres(loaded_.front().table.header().cycle);
  } else {
    const auto& encoder = configuration.setup.master_encoder;
    if (encoder_node_ != 0 && encoder && encoder->position_increment) master_kind_ = CamTable::Kind::linear;
    cycle_ = master_kind_ == CamTable::Kind::linear ? 1.0 : 2.0 * std::numbers::pi;
  }
  const bool rotary = master_kind_ == CamTable::Kind::rotary;
  try {
    speed_ = machine::parse_quantity(options.speed, rotary ? "rad/s" : "m/s") / cycle_;
  } catch (const machine::UnitError& error) {
    throw StartRefused(fmt::format("--speed: found '{}' ({}); expected a speed of the master, which is {}, such as {}",
                                   options.speed, error.what(), name_of(master_kind_),
                                   rotary ? "\"130 rpm\"" : "\"0.5 m/s\""));
  }
  const auto& timing = configuration.machine.timing;
  const double period = timing.fast_period;
  if (!(speed_ > 0.0) || speed_ * period > 0.25)
    throw StartRefused(fmt::format("--speed: found '{}'; expected more than 0 and at most a quarter of a cycle a tick",
                                   options.speed));
  auto bounds = machine::master_bounds(speed_);
  CamMaster::Config config;
  if (master_axis_) {
    const auto& axis = configuration.machine.axes[*master_axis_];
    const auto of_axis = machine::cam_bounds(timing, axis);
    // Half of what the axis may: who follows it needs room for the way to it.
    bounds.acceleration = 0.5 * of_axis.acceleration / cycle_;
    bounds.jerk = 0.5 * of_axis.jerk / cycle_;
    config.measured = true;
    config.cycle = Span::of(std::llround(std::ldexp(cycle_, MotionPoint::position_bits)));
    // A set position is exact: a fast estimator.
    config.estimator.bits = 3;
    config.estimator.look_ahead = 1 << 16;
    config.estimator.jump = std::int64_t{1} << 54;
  }
  if (encoder_node_ != 0) set_up_encoder(configuration, config);
  master_limits_ = machine::motion_limits(bounds, period);
  config.virtual_master = VirtualMaster::Config::of(master_limits_);
  master_ = CamMaster(config);
  run_speed_ = machine::master_speed(speed_, period);
  const std::int64_t ticks = config.virtual_master.rule.ticks(master_limits_.velocity);
  short_stop_ = static_cast<double>(ticks) * period <= longest_stop;
  // A tenth of the master's speed where clients may shift its phase.
  if (options.hold) return;
  phasing_limits_ = machine::motion_limits(machine::master_bounds(0.1 * speed_), period);
}

void CamDrive::set_up_axes(const DriveConfiguration& configuration, bool serves) {
  const auto& timing = configuration.machine.timing;
  const std::int64_t jump = encoder_       ? std::int64_t{1} << 34
                            : master_axis_ ? std::int64_t{1} << 30
                                           : 1024;  // 2^-40 cycles
  for (std::size_t i = 0; i < configuration.names.size(); ++i) {
    const auto& axis = configuration.machine.axes[i];
    auto& config = configs_.emplace_back();
    const auto& setup = configuration.setup.axes.at(axis.name);
    // What a client superposes has its share of what the axis keeps, and what it follows the rest.
    const double superposed = setup.cam.superposed_share;
    const auto shared = [&](double share) {
      auto bounds = machine::cam_bounds(timing, axis);
      bounds = {share * bounds.velocity, share * bounds.acceleration, share * bounds.jerk};
      return machine::motion_limits(bounds, timing.fast_period);
    };
    config.motion =
        CamMotion::Config::of(shared(serves ? 1.0 - superposed : 1.0), master_limits_, phasing_limits_, jump);
    config.superposed = shared(superposed);
    config.superposed_ramp = SpeedRampRule::of(config.superposed);
    config.second = CamMotion::Config::of(config.superposed, master_limits_, phasing_limits_, jump);
    config.rate = S::rate(configuration.period_ns);
    const auto deceleration = [&](double a) {
      return Span::of(machine::motion_limits({0.0, a, 0.0}, timing.fast_period).acceleration);
    };
    const double quick = setup.quick_stop_deceleration;
    config.stops = {deceleration(setup.slow_down_deceleration.value_or(quick)), deceleration(quick)};
    config.low = machine::to_signal<S::Position>(setup.negative_end.value()).value_or(S::Position{});
    config.high = machine::to_signal<S::Position>(setup.positive_end.value()).value_or(S::Position{});
    modes_.emplace_back(config, tables_);
    if (i > 0) modes_.back().join(modes_.front());
  }
  if (serves) return;
  if (!tables_.empty()) start_ = metres(tables_.front().curve.slopes({}).position);
}

void CamDrive::set_up_tracks(const DriveConfiguration& configuration) {
  const double period = configuration.machine.timing.fast_period;
  const auto place = [](double cycles) { return static_cast<std::uint32_t>(std::llround(std::ldexp(cycles, 32))); };
  const auto key = [](std::size_t k, const char* name) {
    return fmt::format("drive.cam_switch.track{}.{}", k + 1, name);
  };
  const auto time = [&](double seconds, const std::string& of) {
    const double ticks = std::ldexp(seconds / period, CamSwitch::time_bits);
    if (std::abs(ticks) > 0x1p31 - 1.0)
      throw StartRefused(
          fmt::format("{}: found {:g} s; expected at most {:g} s, 32768 ticks", of, seconds, 32767.0 * period));
    return static_cast<std::int32_t>(std::llround(ticks));
  };
  track_forces_.enabled = 0;
  const auto setups = machine::tracks_of(configuration.setup.cam_switch);
  for (std::size_t k = 0; k < tracks; ++k) {
    const auto& setup = *setups[k];
    if (setup.line < 0) continue;
    auto& track = tracks_[k];
    track.first = place(setup.first);
    track.last = place(setup.last);
    track.hysteresis = place(setup.hysteresis);
    track.kind = static_cast<CamSwitch::Kind>(setup.kind);
    track.direction = static_cast<CamSwitch::Direction>(setup.direction);
    track.duration = time(setup.duration, key(k, "duration"));
    track.on_compensation = time(setup.on_compensation, key(k, "on_compensation"));
    track.off_compensation = time(setup.off_compensation, key(k, "off_compensation"));
    if (track.kind == CamSwitch::Kind::duration && track.duration <= 0)
      throw StartRefused(
          fmt::format("{}: found 0 s; expected more, the time for which the track is on", key(k, "duration")));
    track_forces_.enabled |= std::uint32_t{1} << k;
    has_tracks_ = true;
  }
}

std::uint32_t CamDrive::step_tracks(bool wanted) {
  if (!has_tracks_) return 0;
  const auto& reading = master_.reading();
  const auto on = CamSwitch::step(tracks_, track_state_, reading.point, track_forces_).on;
  const bool follows =
      std::any_of(modes_.begin(), modes_.end(), [](const CamMode& mode) { return mode.status().active; });
  return wanted && reading.valid && follows ? on : 0;
}

void CamDrive::check_limits(const DriveConfiguration& configuration, bool serves) const {
  const double period = configuration.machine.timing.fast_period;
  for (std::size_t k = 0; k < tables_.size(); ++k) {
    const auto& table = tables_[k];
    std::string found;
    bool fits = false;
    for (std::size_t i = 0; i < configs_.size(); ++i) {
      if (master_axis_ == i || (!serves && i != own_axis_)) continue;
      const auto& config = configs_[i];
      const auto needed = table.curve.motion(config.motion.master_sum);
      const auto& most = config.motion.slave;
      const bool keeps =
          needed.velocity <= most.velocity && needed.acceleration <= most.acceleration && needed.jerk <= most.jerk;
      const bool inside = table.low >= config.low.raw() && table.high <= config.high.raw();
      fits |= keeps && (inside || serves);
      if (!keeps)
        found = fmt::format("axis {}: {}", configuration.names[i],
                            machine::words_of_limits(table.curve, config.motion, period));
      else if (!inside && !serves)
        found = fmt::format(
            "axis {}: found positions from {:.6g} m to {:.6g} m; expected them within the travel, {:.6g} "
            "m to {:.6g} m",
            configuration.names[i], metres(table.low), metres(table.high), machine::to_si(config.low),
            machine::to_si(config.high));
    }
    if (!fits) refuse_table(files_[k], found);
  }
}

void CamDrive::set_up_tuning(const DriveConfiguration& configuration, bool serves) {
  const auto& setup = *configuration.setup.cam_tuning;
  const auto& names = configuration.names;
  const std::string of = configuration.machine.id + ": [drive.cam_tuning]";
  if (!serves) throw StartRefused(of + ": found --hold; expected clients, as an axis that follows for them is tuned");
  TunedAxis::Config config;
  config.axis = master_axis_ == 0 ? 1 : 0;
  if (setup.axis) {
    const auto found = std::find(names.begin(), names.end(), *setup.axis);
    config.axis = static_cast<std::size_t>(found - names.begin());
    if (found == names.end() || config.axis == master_axis_)
      throw StartRefused(fmt::format("{}: found axis {}; expected one that follows the master", of, *setup.axis));
  }
  config.name = names[config.axis];
  if (setup.table > static_cast<int>(tables_.size()))
    throw StartRefused(
        fmt::format("{}: found table {}; expected one of the {} of --cam", of, setup.table, tables_.size()));
  const auto number = static_cast<std::size_t>(setup.table - 1);
  config.number = static_cast<std::uint16_t>(setup.table);
  config.bytes = loaded_[number].bytes;
  const auto& axis = configuration.machine.axes[config.axis];
  const auto& second = axis.second_encoder;
  config.own_encoder = !(second && second->on == machine::EncoderPlace::load);
  if (config.own_encoder && axis.encoder.on != machine::EncoderPlace::load)
    throw StartRefused(
        fmt::format("{}: found axis {} without an encoder at the load; expected one, as that of the motor "
                    "does not see what the shaft does",
                    of, config.name));
  auto& tuner = config.tuner;
  tuner.given = {.table = &loaded_[number].table,
                 .axis = &axis,
                 .mode = {setup.frequency, setup.damping, setup.delay},
                 .speed = setup.speed > 0.0 ? setup.speed : speed_,
                 .period = configuration.machine.timing.fast_period,
                 .increment = config.own_encoder ? axis.encoder.increment : second->increment};
  tuner.quality_limit = setup.quality_limit;
  tuner.steps = setup.steps;
  tuner.pause = setup.pause;
  tuner.by_itself = setup.start == machine::CamTuningStart::by_itself;
  try {
    const auto rise = machine::tuned_rise(*tuner.given.table);
    tuner.amplitude = setup.amplitude.value_or(rise ? 0.1 * std::abs(rise->stroke) : 0.0);
    tuning_ = std::make_unique<TunedAxis>(config);
  } catch (const machine::CamTuningError& error) {
    throw StartRefused(fmt::format("{}: {}: {}", of, files_[number], error.what()));
  }
}

void CamDrive::begin() {
  auto& mode = modes_[own_axis_];
  mode.begin(tables_.front().curve, master_.reading().point);
  master_.run(run_speed_);
}

}  // namespace stiction::drive
