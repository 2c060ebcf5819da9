// Plain text of results as a page prints it: "+-540 N" as "±540 N", "12 um" as "12 µm", friction models by their
// labels.
#pragma once

#include <string>
#include <string_view>

namespace stiction::host {

// The words "um", "urad" and "us" (the latter only where it is the whole text: it is an English word), "^2", "+-", and
// the name of a friction model that begins the text before ":" or "," or ends it behind ", ".
std::string typeset(std::string_view text);

// A text's friction model and the text without it, from "NAME, TEXT" or "TEXT, NAME"; no model and the whole text
// where it names none. A text that is only the name leaves "".
struct NamedModel {
  std::string friction;
  std::string text;
};
NamedModel split_model(std::string_view text);

}  // namespace stiction::host
