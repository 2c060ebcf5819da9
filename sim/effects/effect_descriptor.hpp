// All that the product knows of one effect, in one place. The machine file's reader and reference, the plant, the
// diagnosis, its report, verdict.json and the tables of the documentation take it from here; a descriptor is made by
// described() (describe.hpp) in the effect's own folder.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/value_table.hpp"
#include "sim/effects/carriage_force.hpp"
#include "sim/effects/hidden_draw.hpp"

namespace stiction::sim {

// What a report shows the force of an effect over.
enum class Abscissa {
  none,  // not yet chosen; no effect has it
  position,
  velocity,
  speed,
  acceleration,
  since_reversal,  // way since the last reversal
  time,
  own_force,  // what the records leave over the effect's own force, and nothing beside it
};

// What a log must hold for an effect to be told from it. An inspection says of each whether a log has it.
enum class Need {
  acceleration,     // so much that the mass shows beside the friction
  speeds,           // over a range, so that what is viscous shows
  friction_level,   // both directions at speeds that tell the level from the slope
  offset,           // both directions, so that a force shows that is the same in both
  both_directions,  // of motion
  many_speeds,      // constant ones, over a range of 5 to 1
  slow_speeds,      // constant ones of some mm/s
  small_reversals,  // resolved in the first micrometres behind them
  reversals,
  steady_stroke,  // a constant speed over a stretch
  stroke,         // of the axis
  seconds,        // some of them
  current,        // of the motor, or its voltage; not its force alone
  set_points,
  other_axis,      // its motion, too
  master,          // its position
  second_encoder,  // on the other side of a shaft
  long_record,     // over minutes
};

// Whether any motion of the axis alone tells two effects apart.
enum class Separable {
  by_motion,
  not_by_motion,    // neither from the other
  not_as_this_one,  // what looks like this effect may always be the other, not the other way about
};

// An effect that data of ordinary motion may not tell from this one. A pair stands in one of the two folders.
struct EffectAlias {
  std::string_view other;        // its name in files
  std::string_view separate_by;  // the experiment that tells the two apart
  Separable separable = Separable::by_motion;
};

// What an effect does, by functions of its checked values. Null: it does no such thing.
struct EffectLaw {
  // Throws EffectError for values that do not go together.
  void (*check)(const machine::KeyedValues&) = nullptr;
  // Throws EffectError on an axis, as its file describes it, that cannot have such an effect.
  void (*check_axis)(const machine::KeyedValues&, const machine::AxisModel& axis) = nullptr;
  // The plant's own parameters; the drive keeps the file's. Throws EffectError.
  void (*change)(const machine::KeyedValues&, machine::AxisModel& plant) = nullptr;
  // The drive's parameters; the plant keeps the file's. Throws EffectError.
  void (*change_drive)(const machine::KeyedValues&, machine::AxisModel& drive) = nullptr;
  // A force in each step, on this body of the axis as plant_axis() returns it.
  std::unique_ptr<CarriageForce> (*make_force)(const machine::KeyedValues&, Body, const machine::AxisModel&) = nullptr;
  bool is_friction = false;  // that force
};

// What its folder says of an effect beside its law and its keys.
struct EffectFacts {
  // Its place in the vocabulary; changes of a plant are made in this order. In steps of ten.
  int order = 0;
  std::string_view title;    // of a report: "Force ripple (cogging)"
  std::string_view meaning;  // what it is, a sentence for readers
  std::string_view advice;   // what to do about it at the machine
  std::vector<EffectAlias> aliases;
  Abscissa abscissa = Abscissa::none;
  std::vector<Need> needs;
  // Why rows of two numbers, the largest error and current of a circle, do not show it; empty: they may.
  std::string_view not_in_rows;
  HiddenDraw hidden;
};

// Its name, keys and text are those of its table in the machine file.
struct EffectDescriptor : EffectFacts, machine::ValueTable {
  EffectLaw law;
  std::string_view folder;  // from the repository's root; its page is page.md there
};

// Which effect. Text only at the edges: name() on the way into files and pages, find_effect() on the way back.
class EffectId {
 public:
  explicit constexpr EffectId(const EffectDescriptor& descriptor) : descriptor_(&descriptor) {}

  const EffectDescriptor& operator*() const { return *descriptor_; }
  const EffectDescriptor* operator->() const { return descriptor_; }
  std::string name() const { return std::string(descriptor_->name); }

  friend bool operator==(EffectId, EffectId) = default;
  friend bool operator<(EffectId one, EffectId other) { return one->order < other->order; }

 private:
  const EffectDescriptor* descriptor_;
};

}  // namespace stiction::sim
