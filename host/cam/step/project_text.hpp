// The project of a step cam as a file, and its keys one by one, for who edits them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/cam/step/project.hpp"

namespace stiction::host::step {

// A number of the file: `key` of the table `group` ("" is the file itself), in `unit` (SI) and as a rule written in
// `shown`.
struct ProjectNumber {
  std::string_view group, key, unit, shown, text;
  std::optional<double> (*get)(const StepProject&);  // none: the file does not have it
  void (*set)(StepProject&, std::optional<double>);

  // As messages have it: "load.preload".
  std::string name() const;
};
const std::vector<ProjectNumber>& project_numbers();

// One of a few words; true and false are written without quotation marks. Without `options`: a lift law from rest to
// rest.
struct ProjectChoice {
  std::string_view group, key, text;
  std::vector<std::string_view> options;
  std::string (*get)(const StepProject&);
  void (*set)(StepProject&, std::string_view);

  std::string name() const;
};
const std::vector<ProjectChoice>& project_choices();

// The file of `project`: parse_step_project() gives the same one from it, to the last bit.
std::string project_text(const StepProject& project);

}  // namespace stiction::host::step
