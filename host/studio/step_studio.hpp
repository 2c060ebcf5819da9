// The step cam of a studio: its project, which is edited key by key and by the depth of relief, and what is made of it
// with the motion that the studio has. What can be kept of the last synthesis is kept, so that relief can be dragged.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/cam/step/shop_folder.hpp"
#include "host/studio/studio_table.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

// Projects are shared by the versions of a studio's history and never changed.
using StepProjectPointer = std::shared_ptr<const step::StepProject>;

// A project of usual dimensions for the motion file `motion`: axes 105 mm apart, four rollers a row.
step::StepProject usual_step_project(const std::string& motion);

// The project `text`, whose name in messages is `file`, for one of the `cams` of the open motion file. Throws
// machine::MachineFileError, and sim::cam::CamError for a single cam with a spring.
step::StepProject parsed_step_project(const std::string& file, const std::string& text,
                                      const std::vector<sim::cam::Cam>& cams);

// `project` with its key `name`, such as "load.preload", set to `value` in the unit that the page shows, or left out
// where it is none; or to the word `value`. Checked as a file with that value is. Throws as parsed_step_project() does,
// and sim::cam::CamError for an unknown key.
step::StepProject with_number(const step::StepProject& project, std::string_view name, std::optional<double> value);
step::StepProject with_choice(const step::StepProject& project, std::string_view name, std::string_view value);

// How an arc of the relief is changed: all arcs of its kind, valleys or peaks of both cams, or this one alone.
struct ReliefStep {
  std::size_t arc = 0;                     // of StepSynthesis::arcs
  std::optional<double> depth{}, blend{};  // m, rad
  bool alone = false;
};

class StepStudio {
 public:
  // From now on `project` with the motion of `cam`; nothing where both are what they were. An empty `project` is none.
  // What it becomes is computed where it is asked for. `several`: the motion file has more cams, so that the project
  // has to name its own.
  void set(StepProjectPointer project, const sim::cam::Cam& cam, bool several);

  const step::StepProject* project() const { return project_ ? &*project_ : nullptr; }
  // None without a project and where it cannot be built, which problem() then explains.
  const step::StepSynthesis* made() const;
  const std::string& problem() const;

  // The project after `step`. Throws sim::cam::CamError where relief may not be so.
  step::StepProject relieved(const ReliefStep& step) const;

  // ---- what the page shows ----
  // Keys and values of the project, dimensions, arcs of the relief, and what is wrong; "null" without a project.
  std::string state_json() const;
  // The figures, which take longer than all else.
  std::string figures_json() const;
  // Both profiles: cam, angle, radius before and after relief, corners included.
  StudioTable profiles() const;
  // Contacts over the turn: index of the angle, cam, roller, whether it is needed, gap, pressure angle, force, Hertz
  // pressure, and place in the frame that rests.
  StudioTable contacts() const;
  // Over the turn: angle, angle of the carousel, its torque, that of the cam shaft, load of the bearings, contacts
  // before and after relief; then pressure angle, force and Hertz pressure of the contact that pushes on, and the same
  // of the one that holds back, no numbers where there is none.
  StudioTable turn() const;

  // The files that `stiction cam step` writes, but for its page, with heads of `program`, "stiction 0.1.0". Throws
  // sim::cam::CamError where nothing can be built.
  std::vector<step::ShopFile> files(const std::string& program) const;

 private:
  void make() const;
  const step::StepSynthesis& required() const;

  StepProjectPointer source_;                 // as it was set
  std::optional<step::StepProject> project_;  // with the cam
  std::string key_;                           // all of it but relief, as text
  mutable bool is_made_ = false;
  mutable std::optional<step::StepSynthesis> made_;
  mutable std::string made_of_;  // the key of it
  mutable std::string problem_;
};

}  // namespace stiction::host
