// The table of laws for readers: as Markdown for docs/cam.md, and as a picture.
#pragma once

#include <string>

namespace stiction::sim::cam {

// A row for each law: number, name, German and English names, task, parameters, formula, figures.
std::string laws_markdown();

// Position, speed and acceleration of every law in one SVG picture, each scaled to its own peak.
std::string laws_svg();

}  // namespace stiction::sim::cam
