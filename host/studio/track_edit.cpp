#include "host/studio/track_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "sim/cam/motion_file.hpp"

namespace stiction::host {
namespace {

using sim::cam::Cam;
using sim::cam::CamError;
using sim::cam::Track;

constexpr std::array<std::string_view, 8> verbs{"track",    "untrack",         "track-name",       "window",
                                                "unwindow", "on_compensation", "off_compensation", "hysteresis"};

std::size_t window_of(const Track& track, std::string_view key, std::size_t most) {
  std::size_t k = most;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), k);
  if (error != std::errc{} || k >= most)
    throw CamError(
        fmt::format("found the window {} of track {}; expected one of its {}", key, track.name, track.windows.size()));
  return k;
}

void change(Track& track, const TrackStep& step) {
  auto& windows = track.windows;
  if (step.verb == "track-name") {
    track.name = step.key;
  } else if (step.verb == "window") {
    const auto k = window_of(track, step.key, windows.size() + 1);
    if (k == windows.size()) windows.push_back({});
    windows[k] = {step.x, step.y};
  } else if (step.verb == "unwindow") {
    if (windows.size() < 2) throw CamError("found the only window of a track; expected one of several");
    windows.erase(windows.begin() + static_cast<std::ptrdiff_t>(window_of(track, step.key, windows.size())));
  } else if (step.verb == "on_compensation") {
    track.on_compensation = step.x;
  } else if (step.verb == "off_compensation") {
    track.off_compensation = step.x;
  } else {
    track.hysteresis = step.x;
  }
}

}  // namespace

bool edits_tracks(std::string_view verb) { return std::find(verbs.begin(), verbs.end(), verb) != verbs.end(); }

Cam with_track(const Cam& cam, const TrackStep& step) {
  Cam changed = cam;
  if (step.verb == "track") {
    changed.tracks.push_back({.name = std::string(step.key), .windows = {{step.x, step.y}}});
  } else {
    if (step.at >= cam.tracks.size())
      throw CamError(fmt::format("found track {} of {}; expected one of them", step.at + 1, cam.tracks.size()));
    if (step.verb == "untrack")
      changed.tracks.erase(changed.tracks.begin() + static_cast<std::ptrdiff_t>(step.at));
    else
      change(changed.tracks[step.at], step);
  }
  // Its rules are those of a file.
  for (const Track& track : changed.tracks)
    if (track.name.empty() || track.name.find_first_of("\"\\\n") != std::string::npos)
      throw CamError(
          fmt::format("found the track name \"{}\"; expected one without quotes and backslashes", track.name));
  return sim::cam::parse_motion_file("motion", sim::cam::motion_text({changed})).front();
}

}  // namespace stiction::host
