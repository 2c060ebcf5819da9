// [axis.NAME.friction_compensation] of a machine file: what is taken, and what is refused with which words.
#include <gtest/gtest.h>

#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/firmware/machine/machine_text.hpp"

namespace stiction::machine {
namespace {

using test::error_of;
using test::replaced;
using test::small_machine;

std::string list_of_23(const std::string& value) {
  std::string list = "[";
  for (int k = 0; k < 23; ++k) list += (k > 0 ? ", \"" : "\"") + value + "\"";
  return list + "]";
}

const std::string with_compensation = small_machine + R"([timing]
set_point_delay = "500 us"
[axis.B.friction_compensation]
use = "learning"
[axis.B.friction_compensation.pulse]
amplitude = "1 mm/s"
rise_until = "0.1 m/s^2"
flat_until = "1 m/s^2"
fall_until = "4 m/s^2"
duration = "20 ms"
[axis.B.friction_compensation.friction]
look_ahead = "250 us"
distance = ["2 um", "20 um", "200 um"]
level = ["0.2 V", "0.3 V", "0.1 V"]
contact_damping = "2 ms"
speed = ["1 mm/s", "10 mm/s", "0.1 m/s"]
forward = ["0.01 V", "0.1 V", "0.5 V"]
backward = ["0.01 V", "0.1 V", "0.6 V"]
[axis.B.friction_compensation.learning]
limit = "0.3 V"
[axis.B.friction_compensation.learned]
machine = "small"
axis = "B"
forward = )" + list_of_23("0.1 V") +
                                      "\nbackward = " + list_of_23("-0.1 V") + "\n";

std::string error_after(const std::string& from, const std::string& to) {
  const std::string error = error_of(replaced(with_compensation, from, to));
  const std::string key = "axis.B.friction_compensation.";
  const auto at = error.find(key);
  return at == std::string::npos ? error : error.substr(at + key.size());
}

TEST(CompensationFile, is_taken_as_it_stands) { EXPECT_EQ(error_of(with_compensation), "accepted"); }

TEST(CompensationFile, tables_that_do_not_rise_are_refused) {
  EXPECT_EQ(error_after("\"20 um\", \"200 um\"", "\"20 um\", \"20 um\""),
            "friction.distance: found 20 um after 20 um; expected values that increase");
  EXPECT_EQ(error_after("\"10 mm/s\", \"0.1 m/s\"", "\"10 mm/s\", \"5 mm/s\""),
            "friction.speed: found 0.005 m/s after 0.01 m/s; expected values that increase");
  EXPECT_EQ(error_after("flat_until = \"1 m/s^2\"", "flat_until = \"0.05 m/s^2\""),
            "pulse.flat_until: found 0.05 m/s^2; expected more than 0.1 m/s^2, the value of rise_until");
  EXPECT_EQ(error_after("fall_until = \"4 m/s^2\"", "fall_until = \"1 m/s^2\""),
            "pulse.fall_until: found 1 m/s^2; expected more than 1 m/s^2, the value of flat_until");
}

TEST(CompensationFile, lists_of_unequal_length_are_refused) {
  EXPECT_EQ(error_after(", \"0.1 V\"]\ncontact", "]\ncontact"),
            "friction.level: found a list of 2; expected a list of 3, as many as distance has");
  EXPECT_EQ(error_after(", \"0.6 V\"]", "]"),
            "friction.backward: found a list of 2; expected a list of 3, as many as speed has");
}

TEST(CompensationFile, amplitudes_beyond_what_the_drive_can_give_are_refused) {
  EXPECT_EQ(error_after("\"0.3 V\", \"0.1 V\"]\ncontact", "\"9.9 V\", \"0.1 V\"]\ncontact"),
            "friction.level: found 10.2 V in all; expected at most 10 V, the axis' voltage limit");
  EXPECT_EQ(error_after("\"0.6 V\"]", "\"9.5 V\"]"),
            "friction.backward: found 10.1 V with the Coulomb level; expected at most 10 V, the axis' voltage limit");
  EXPECT_EQ(error_after("amplitude = \"1 mm/s\"", "amplitude = \"0.3 m/s\""),
            "pulse.amplitude: found 0.3 m/s; expected at most 0.2 m/s, the axis' max_velocity");
  EXPECT_EQ(error_after("limit = \"0.3 V\"", "limit = \"11 V\""),
            "learning.limit: found 11 V; expected at most 10 V, the axis' voltage limit");
}

TEST(CompensationFile, a_look_ahead_longer_than_the_buffer_is_refused) {
  EXPECT_EQ(error_after("look_ahead = \"250 us\"", "look_ahead = \"600 us\""),
            "friction.look_ahead: found 600 us; expected at most 500 us, the value of timing.set_point_delay: the "
            "buffer of set-points that it looks into");
  const std::string error = error_of(replaced(with_compensation, "\"500 us\"", "\"1 ms\""));
  EXPECT_NE(error.find("timing.set_point_delay: found 1000 us; expected at most 937.5 us, 15 times fast_period"),
            std::string::npos)
      << error;
  EXPECT_NE(error_of(replaced(with_compensation, "\"500 us\"", "\"510 us\"")).find("a multiple of fast_period"),
            std::string::npos);
}

TEST(CompensationFile, a_learned_table_of_another_machine_is_refused) {
  EXPECT_EQ(error_after("machine = \"small\"", "machine = \"large\""),
            "learned.machine: found \"large\"; expected a table learned by axis B of \"small\"");
  EXPECT_EQ(error_after("axis = \"B\"", "axis = \"C\""),
            "learned.axis: found \"C\"; expected a table learned by axis B of \"small\"");
  EXPECT_EQ(error_after("forward = " + list_of_23("0.1 V"), "forward = [\"0.1 V\"]"),
            "learned.forward: found a list of 1; expected a list of 23");
  EXPECT_EQ(error_after("forward = " + list_of_23("0.1 V"), "forward = " + list_of_23("0.4 V")),
            "learned.forward: found 0.4 V; expected at most 0.3 V in magnitude, the limit of learning");
}

TEST(CompensationFile, a_learned_table_with_a_foreign_unit_is_refused) {
  const std::string error = error_after("forward = " + list_of_23("0.1 V"), "forward = [\"1 mol\"]");
  EXPECT_TRUE(error.starts_with("learned.forward[0]: found \"1 mol\" (dimension mol, not ")) << error;
}

TEST(CompensationFile, a_kind_without_its_table_is_refused) {
  const std::string bare = small_machine + "[axis.B.friction_compensation]\nuse = ";
  EXPECT_NE(error_of(bare + "\"friction\"\n")
                .find("found \"friction\", without a table 'friction'; expected the table "
                      "[axis.B.friction_compensation.friction] too"),
            std::string::npos);
  EXPECT_NE(error_of(bare + "\"pulse\"\n").find("without a table 'pulse'"), std::string::npos);
  EXPECT_NE(error_of(bare + "\"learning\"\n").find("without a table 'friction'"), std::string::npos);
  EXPECT_EQ(error_of(bare + "\"off\"\n"), "accepted");
  EXPECT_NE(error_of(bare + "\"magic\"\n").find("expected \"off\", \"pulse\", \"friction\" or \"learning\""),
            std::string::npos);
}

TEST(CompensationFile, sliding_list_is_read_at_the_drives_nodes) {
  const std::vector<double> speeds{0.01, 0.1}, values{1.0, 2.0};
  EXPECT_DOUBLE_EQ(sliding_value(speeds, values, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(sliding_value(speeds, values, 0.005), 0.5);
  EXPECT_DOUBLE_EQ(sliding_value(speeds, values, 0.055), 1.5);
  EXPECT_NEAR(sliding_value(speeds, values, 0.19), 3.0, 1e-12) << "goes on with its last slope";
  const auto nodes = sliding_node_speeds();
  ASSERT_EQ(nodes.size(), FixedSignals::speed_nodes);
  EXPECT_EQ(nodes[0], 0.0);
  EXPECT_EQ(nodes[1], 0x1p-12);
  EXPECT_EQ(nodes[2], 1.5 * 0x1p-12);
}

TEST(CompensationFile, identity_tells_machines_and_axes_apart) {
  EXPECT_NE(learning_identity("a", "X"), learning_identity("a", "Y"));
  EXPECT_NE(learning_identity("a", "X"), learning_identity("b", "X"));
  EXPECT_NE(learning_identity("a", "bX"), learning_identity("ab", "X"));
}

}  // namespace
}  // namespace stiction::machine
