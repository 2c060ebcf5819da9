// No effect lacks a part: what its descriptor says, its page, its regressor, and a draw that makes a plant.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/units.hpp"
#include "host/diagnose/classes/effect_regressor.hpp"
#include "sim/effects/effects.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/axis_plant.hpp"

namespace stiction::test {
namespace {

const std::filesystem::path root = STICTION_SOURCE_DIR;

machine::Machine shipped(const char* name = "mcfv5050ln.toml") {
  return sim::read_machine(root / "firmware" / "machine" / "shipped" / name);
}

// The test rig where the effect is one of an elastic shaft.
machine::Machine that_takes(sim::EffectId effect) {
  auto machine = shipped();
  sim::Draw draw(1);
  auto axis = machine.axes.front();
  axis.effects = {sim::effect_with(effect, effect->hidden.values(axis, draw))};
  try {
    sim::AxisPlant(machine.timing, axis, 0.0, 1);
  } catch (const sim::EffectError&) {
    return shipped("cam-stand.toml");
  }
  return machine;
}

std::string page_of(sim::EffectId effect) {
  std::ifstream stream(root / effect->folder / "page.md");
  return {std::istreambuf_iterator<char>(stream), {}};
}

class EachEffect : public testing::TestWithParam<std::size_t> {
 protected:
  sim::EffectId effect() const { return sim::all_effects()[GetParam()]; }
};

bool is_sentence(std::string_view text) {
  return text.size() > 20 && std::isupper(static_cast<unsigned char>(text.front())) && text.back() == '.';
}

TEST_P(EachEffect, IsNamedByItsFolder) {
  EXPECT_EQ(std::filesystem::path(effect()->folder).filename(), effect().name());
  EXPECT_EQ(sim::find_effect(effect().name()), effect());
}

TEST_P(EachEffect, SaysWhatItIsAndWhatToDoAboutIt) {
  EXPECT_FALSE(effect()->text.empty());
  EXPECT_FALSE(effect()->title.empty());
  EXPECT_TRUE(is_sentence(effect()->meaning)) << effect()->meaning;
  EXPECT_TRUE(is_sentence(effect()->advice)) << effect()->advice;
}

TEST_P(EachEffect, HasKeysWithUnitsAndTexts) {
  ASSERT_FALSE(effect()->keys.empty());
  for (const auto& key : effect()->keys) {
    EXPECT_FALSE(key.key.empty());
    EXPECT_FALSE(key.text.empty()) << key.key;
    for (const auto unit : {key.unit, key.unit_of_force_motor})
      if (!unit.empty()) {
        EXPECT_EQ(machine::parse_quantity("2 " + std::string(unit), unit), 2.0) << key.key;
      }
  }
}

TEST_P(EachEffect, HasAPageWithItsPartsAndKeys) {
  const auto page = page_of(effect());
  EXPECT_TRUE(page.starts_with("# " + effect().name() + ": ")) << effect()->folder << "/page.md";
  std::size_t at = 0;
  for (const char* part :
       {"## Physics", "## Signature", "## Confused with", "## Separating experiment", "## What to do about it"}) {
    const auto found = page.find(std::string("\n") + part + "\n", at);
    ASSERT_NE(found, std::string::npos) << part;
    EXPECT_GT(page.size(), found + std::string_view(part).size() + 20) << part;
    at = found;
  }
  for (const auto& key : effect()->keys)
    EXPECT_NE(page.find("`" + std::string(key.key) + "`"), std::string::npos) << key.key;
}

TEST_P(EachEffect, IsConfusedWithEffectsThatAreThere) {
  std::set<std::string_view> others;
  for (const auto& alias : effect()->aliases) {
    const auto other = sim::find_effect(alias.other);
    ASSERT_TRUE(other) << alias.other;
    EXPECT_NE(*other, effect());
    EXPECT_GT(alias.separate_by.size(), 20U) << alias.other;
    EXPECT_TRUE(others.insert(alias.other).second) << alias.other << " twice";
    for (const auto& back : (*other)->aliases)
      EXPECT_NE(back.other, effect()->name) << "the pair stands in both folders";
  }
  // A page of the product does not know the effect that is made up.
  const auto parent = [](sim::EffectId id) { return std::filesystem::path(id->folder).parent_path(); };
  const auto page = page_of(effect());
  for (const auto& confusion : sim::confusions_of(effect()))
    if (others.contains(confusion.other->name) || parent(confusion.other) == parent(effect())) {
      EXPECT_NE(page.find("`" + confusion.other.name() + "`"), std::string::npos)
          << "the page does not name " << confusion.other.name();
    }
}

TEST_P(EachEffect, SaysFromWhatRecordsItIsToldAndOverWhatItIsDrawn) {
  EXPECT_FALSE(effect()->needs.empty());
  EXPECT_NE(effect()->abscissa, sim::Abscissa::none);
}

TEST_P(EachEffect, HasALaw) {
  const auto& law = effect()->law;
  // These act at places of their own, in the plant or on the set-points of a run, which look them up by their class.
  const std::set<std::string_view> of_the_plant{
      "backlash",     "encoder_subdivision_error", "force_saturation", "structural_resonance", "cross_axis_coupling",
      "master_delay", "transmission_error"};
  ASSERT_NE(law.check, nullptr);
  EXPECT_TRUE(law.change != nullptr || law.change_drive != nullptr || law.make_force != nullptr ||
              of_the_plant.contains(effect()->name));
}

TEST_P(EachEffect, IsLookedForOrSaysWhyNot) {
  const auto* regressor = host::regressor_of(effect());
  ASSERT_NE(regressor, nullptr) << effect()->folder << "/regressor.cpp";
  const bool in_force = regressor->force.columns != nullptr;
  const bool between_encoders = regressor->encoders.columns != nullptr;
  EXPECT_TRUE(in_force || !regressor->command.empty() || between_encoders || !regressor->not_looked_for.empty());
  EXPECT_EQ(host::candidate_index(effect()).has_value(), in_force);
  for (const auto& parameter : regressor->command)
    EXPECT_NO_THROW(host::effect_parameter(shipped().axes.front(), effect(), parameter.key, {}, {})) << parameter.key;
  if (!in_force) return;
  EXPECT_NE(regressor->force.grid, nullptr);
  EXPECT_NE(regressor->force.possible, nullptr);
  EXPECT_NE(regressor->force.describe, nullptr);
}

// Whatever is drawn passes its checks, and the plant that has it runs a tick.
TEST_P(EachEffect, IsDrawnWithinItsRanges) {
  ASSERT_NE(effect()->hidden.values, nullptr);
  const auto machine = that_takes(effect());
  for (auto axis : machine.axes)
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      sim::Draw draw(seed);
      const auto drawn = sim::effect_with(effect(), effect()->hidden.values(axis, draw));
      ASSERT_NO_THROW(sim::check_effect(drawn)) << axis.name << seed;
      EXPECT_TRUE(std::any_of(drawn.values.begin(), drawn.values.end(), [](const auto& each) {
        return std::any_of(each.second.begin(), each.second.end(), [](double value) { return value != 0.0; });
      })) << "nothing hidden";
      axis.effects = {drawn};
      ASSERT_NO_THROW(sim::drive_axis(axis)) << axis.name << seed;
      sim::AxisPlant plant(machine.timing, axis, 0.0, seed);
      plant.command({}, true);
      plant.advance_tick();
      EXPECT_TRUE(std::isfinite(plant.read_encoder())) << axis.name << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Effects, EachEffect, testing::Range<std::size_t>(0, sim::all_effects().size()),
                         [](const auto& info) { return sim::all_effects()[info.param].name(); });

TEST(Effects, HavePlacesOfTheirOwn) {
  std::set<int> orders, demonstrated;
  for (const auto effect : sim::all_effects()) {
    EXPECT_TRUE(orders.insert(effect->order).second) << effect.name();
    if (const auto place = effect->hidden.demonstrated) {
      EXPECT_TRUE(demonstrated.insert(*place).second) << effect.name();
    }
  }
  EXPECT_GE(demonstrated.size(), 10U);
}

}  // namespace
}  // namespace stiction::test
