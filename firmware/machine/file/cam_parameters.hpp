// The keys under [drive] of cams: their master, switch tracks, tuning, and the share of an axis; as
// drive_parameters.hpp for the rest.
#pragma once

#include <array>
#include <tuple>

#include "firmware/machine/file/parameter_tables.hpp"
#include "firmware/machine/model/drive_setup.hpp"

namespace stiction::machine {

inline constexpr Range line_numbers{-1, 1023};  // of a gpiochip

template <>
struct Table<MasterEncoderSetup> : EmptyTable<MasterEncoderSetup> {
  static constexpr std::string_view text = "encoder on a CAN bus (CiA 406) that axes follow as their master";
  static constexpr std::array<TextParameter<MasterEncoderSetup>, 1> texts{
      {{"interface", &MasterEncoderSetup::interface,
        "name of the network interface; may be that of [drive.can_server]"}}};
  static constexpr std::array<Parameter<MasterEncoderSetup>, 5> parameters{{
      {"period",
       "s",
       {100e-6, 20e-3},
       &MasterEncoderSetup::period,
       1e-3,
       "time from one position to the next: its cycle timer (6200h), or the period of SYNC"},
      {"counts_per_turn", "1", not_negative(4294967296.0), &MasterEncoderSetup::counts_per_turn, 0.0,
       "positions of a revolution (6001h); 0: it is not a rotary one"},
      {"position_increment",
       "m",
       positive(1e-3),
       &MasterEncoderSetup::position_increment,
       {},
       "a position of a linear one; left out: it is not a linear one"},
      {"range",
       "1",
       {16, 4294967296.0},
       &MasterEncoderSetup::range,
       4294967296.0,
       "total measuring range (6002h): positions after which the value begins again at 0"},
      {"delay", "s", not_negative(0.1), &MasterEncoderSetup::delay, 0.0,
       "time from the measurement to the arrival of its frame"},
  }};
};

inline constexpr std::array<Choice<bool>, 2> track_levels{{
    {"high", false, "high"},
    {"low", true, "low"},
}};
inline constexpr std::array<Choice<TrackKind>, 2> track_kinds{{
    {"position", TrackKind::position, "from first to last"},
    {"duration", TrackKind::duration, "from first on for the duration"},
}};
inline constexpr std::array<Choice<TrackDirection>, 3> track_directions{{
    {"both", TrackDirection::both, "either"},
    {"positive", TrackDirection::positive, "that of a positive speed"},
    {"negative", TrackDirection::negative, "that of a negative speed"},
}};

template <>
struct Table<TrackSetup> : EmptyTable<TrackSetup> {
  static constexpr std::string_view text = "a track of the cam switch on the master, and the line that it drives";
  static constexpr std::tuple choices{
      ChoiceParameter<TrackSetup, bool>{"active", &TrackSetup::active_low, track_levels, false,
                                        "level of the line while the track is on"},
      ChoiceParameter<TrackSetup, TrackKind>{"kind", &TrackSetup::kind, track_kinds, TrackKind::position,
                                             "when the track is on"},
      ChoiceParameter<TrackSetup, TrackDirection>{"direction", &TrackSetup::direction, track_directions,
                                                  TrackDirection::both, "direction in which the track switches on"},
  };
  static constexpr std::array<Parameter<TrackSetup>, 7> parameters{{
      {"line", "1", line_numbers, &TrackSetup::line, -1.0, "line of the gpiochip by its number; -1: no such track"},
      {"first", "1", {0, 1}, &TrackSetup::first, 0.0, "place of the master, in cycles, at which the track switches on"},
      {"last",
       "1",
       {0, 1},
       &TrackSetup::last,
       0.0,
       "place at which it switches off; before first: around the begin of the cycle"},
      {"duration", "s", not_negative(2.0), &TrackSetup::duration, 0.0, "time of the kind duration"},
      {"on_compensation",
       "s",
       {-1, 1},
       &TrackSetup::on_compensation,
       0.0,
       "time by which the track switches on later; negative is earlier"},
      {"off_compensation",
       "s",
       {-1, 1},
       &TrackSetup::off_compensation,
       0.0,
       "time by which it switches off later; negative is earlier"},
      {"hysteresis",
       "1",
       {0, 0.25},
       &TrackSetup::hysteresis,
       0.0,
       "way of a master that goes back, in cycles, for which an edge is held"},
  }};
};

template <>
struct Table<CamSwitchSetup> : EmptyTable<CamSwitchSetup> {
  static constexpr std::string_view text = "cam switch on the master of the axes, while one of them follows a curve";
  static constexpr std::tuple subtables{
      Subtable<CamSwitchSetup, TrackSetup>{"track1", &CamSwitchSetup::track1, Presence::optional},
      Subtable<CamSwitchSetup, TrackSetup>{"track2", &CamSwitchSetup::track2, Presence::optional},
      Subtable<CamSwitchSetup, TrackSetup>{"track3", &CamSwitchSetup::track3, Presence::optional},
      Subtable<CamSwitchSetup, TrackSetup>{"track4", &CamSwitchSetup::track4, Presence::optional},
      Subtable<CamSwitchSetup, TrackSetup>{"track5", &CamSwitchSetup::track5, Presence::optional},
      Subtable<CamSwitchSetup, TrackSetup>{"track6", &CamSwitchSetup::track6, Presence::optional},
      Subtable<CamSwitchSetup, TrackSetup>{"track7", &CamSwitchSetup::track7, Presence::optional},
      Subtable<CamSwitchSetup, TrackSetup>{"track8", &CamSwitchSetup::track8, Presence::optional}};
};

inline constexpr std::array<Choice<CamTuningStart>, 2> cam_tuning_starts{{
    {"by-hand", CamTuningStart::by_hand, "by a command of a client alone"},
    {"by-itself", CamTuningStart::by_itself, "also where the quality number is above its limit in three cycles"},
}};

template <>
struct Table<CamTuningSetup> : EmptyTable<CamTuningSetup> {
  static constexpr std::string_view text =
      "residual vibration of an axis behind a table, measured and cancelled by the drive; frequency, damping and delay "
      "are those that `stiction tune-cam` finds";
  static constexpr std::array<TextParameter<CamTuningSetup>, 1> texts{
      {{"axis", &CamTuningSetup::axis, "name of the axis; left out: the first one that is not the master"}}};
  static constexpr std::tuple choices{ChoiceParameter<CamTuningSetup, CamTuningStart>{
      "start", &CamTuningSetup::start, cam_tuning_starts, CamTuningStart::by_hand, "when tuning begins"}};
  static constexpr std::array<Parameter<CamTuningSetup>, 9> parameters{{
      {"table",
       "1",
       {1, 65535},
       &CamTuningSetup::table,
       1.0,
       "table that is tuned, by its number in the order of --cam"},
      {"frequency", "Hz", {0.1, 1000}, &CamTuningSetup::frequency, {}, "frequency of the load behind the drive"},
      {"damping_ratio", "1", {0, 0.2}, &CamTuningSetup::damping, 0.01, "damping ratio of the load"},
      {"delay", "s", not_negative(0.1), &CamTuningSetup::delay, 0.0, "time by which the encoder at the load is late"},
      {"speed", "1/s", not_negative(1000.0), &CamTuningSetup::speed, 0.0,
       "cycles of the master in a second at which the cam is tuned; 0: those of --speed"},
      {"amplitude",
       "m",
       positive(1.0),
       &CamTuningSetup::amplitude,
       {},
       "largest amplitude of a pulse; left out: a tenth of the stroke"},
      {"quality_limit", "m", not_negative(1.0), &CamTuningSetup::quality_limit, 0.0,
       "area of the load's vibration over a dwell, in metres times cycles of the master, above which the cam is to be "
       "tuned again; 0: it is not watched"},
      {"steps", "1", {1, 20}, &CamTuningSetup::steps, 6.0, "tables that are tried from one start on, at most"},
      {"pause",
       "1",
       {1, 1e6},
       &CamTuningSetup::pause,
       50.0,
       "cycles of the master from one start that the drive makes by itself to the next, at least"},
  }};
};

template <>
struct Table<CamAxisSetup> : EmptyTable<CamAxisSetup> {
  static constexpr std::string_view text = "the axis in the modes of cam and gear";
  static constexpr std::array<Parameter<CamAxisSetup>, 1> parameters{{
      {"superposed_share",
       "1",
       {0.001, 0.9},
       &CamAxisSetup::superposed_share,
       0.1,
       "share of velocity, acceleration and jerk of the axis that a superposed move or a second cam may take; the rest "
       "is for what the axis follows"},
  }};
};

}  // namespace stiction::machine
