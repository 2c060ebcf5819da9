// Editing the switch tracks of a cam.
#pragma once

#include <string_view>

#include "sim/cam/motion.hpp"

namespace stiction::host {

// A change of the track `at` of a cam. `verb`: "track" (one more behind all others, named `key`, on from `x` to `y`),
// "untrack" (without it), "track-name" (`key`), "window" (its window `key`, counted from 0, to `x` and `y`; behind the
// last one a window more), "unwindow" (without its window `key`), "on_compensation", "off_compensation" and
// "hysteresis"
// (`x`).
struct TrackStep {
  std::string_view verb;
  std::size_t at = 0;
  std::string_view key{};
  double x = 0.0, y = 0.0;
};

// Whether `verb` is one of them.
bool edits_tracks(std::string_view verb);

// `cam` after `step`, checked as a motion file with it is. Throws sim::cam::CamError and machine::MachineFileError.
sim::cam::Cam with_track(const sim::cam::Cam& cam, const TrackStep& step);

}  // namespace stiction::host
