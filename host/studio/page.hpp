// The studio as one HTML file, which opens offline: style, scripts, the compiled programme and the files it begins with
// are inside it.
#pragma once

#include <optional>
#include <string>

namespace stiction::host {

struct StudioFile {
  std::string name, text;  // as messages have it, and the content
};

struct StudioPageContent {
  std::optional<StudioFile> motion;   // none: an empty studio
  std::optional<StudioFile> machine;  // none: curves alone
  std::optional<StudioFile> step;     // project of a step cam of that motion
  double master_speed = 0.0;          // rad/s or m/s
  std::string speed_text;             // as the command line has it: "130 rpm"
  std::string command, version;       // of the one who writes it
};

// The page of `content`. Throws what reading its files throws.
std::string studio_page(const StudioPageContent& content);

}  // namespace stiction::host
