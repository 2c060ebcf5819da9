// What a bad machine file is told: place, key, what was found, what was expected.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sim/machine_file.hpp"
#include "tests/firmware/machine/machine_text.hpp"

namespace stiction::machine {
namespace {

using test::error_after;
using test::error_of;
using test::error_of_set;
using test::replaced;
using test::small_machine;

// Several keys of several tables, missing, unknown and out of range: a line each, with its place.
TEST(MachineFileError, AllErrorsOfAFileAreToldAtOnce) {
  auto text = replaced(small_machine, "95 kg", "-3 kg");
  text = replaced(text, "travel = \"250 mm\"\n", "");
  text = replaced(text, "gain = \"243 V s/m\"", "gian = \"243 V s/m\"");
  text = replaced(text, "coulomb = \"20 N\"", "coulomb = \"20 A\"");
  try {
    test::read_text(text, {.experiment = {}, .set = {}, .all_errors = true});
    FAIL();
  } catch (const MachineFileError& error) {
    const std::string all = error.what();
    for (const char* part : {":4: axis.B.mass: found \"-3 kg\"", ":3: axis.B.travel: found no such key",
                             ":19: axis.B.velocity_controller.gian: found an unknown key",
                             ":18: axis.B.velocity_controller.gain: found no such key",
                             ":23: axis.B.friction.lugre.coulomb: found \"20 A\""})
      EXPECT_NE(all.find(part), std::string::npos) << part << " in\n" << all;
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 4) << all;
  }
  EXPECT_EQ(error_of(text).find('\n'), std::string::npos);
}

TEST(MachineFileError, SmallMachineOfTheseTestsIsValid) { EXPECT_EQ(error_of(small_machine), "accepted"); }

TEST(MachineFileError, ValueOutOfRange) {
  EXPECT_EQ(error_after("95 kg", "-3 kg"),
            "FILE:4: axis.B.mass: found \"-3 kg\"; expected a value greater than 0 kg (moving mass)");
  EXPECT_EQ(error_after("95 kg", "0 kg"),
            "FILE:4: axis.B.mass: found \"0 kg\"; expected a value greater than 0 kg (moving mass)");
  EXPECT_EQ(error_after("50 nm", "-1 nm"),
            "FILE:15: axis.B.encoder.increment: found \"-1 nm\"; expected a value of at least 0 m (increment after "
            "interpolation; 0: continuous)");
  EXPECT_EQ(error_after("35 N/V\"", "35 N/V\"\ncount = 65"),
            "FILE:11: axis.B.motor.count: found 65; expected a whole number from 1 to 64 (motors in parallel on one "
            "servo module)");
  EXPECT_EQ(error_after("35 N/V\"", "35 N/V\"\ncount = 99999999999"),
            "FILE:11: axis.B.motor.count: found 99999999999; expected a whole number from 1 to 64 (motors in parallel "
            "on one servo module)");
  EXPECT_EQ(error_after("damping_ratio", "static_ratio = 0.9\ndamping_ratio"),
            "FILE:28: axis.B.friction.lugre.static_ratio: found 0.9; expected a number from 1 to 10 (static over "
            "Coulomb friction, F_Ts / F_C)");
}

// Found by the fuzzer: the plant divides by the mass.
TEST(MachineFileError, MagnitudeBeyondAllMachines) {
  for (const std::string mass : {"5e-324 kg", "0.9e-30 kg", "1.1e30 kg"})
    EXPECT_EQ(
        error_of(replaced(small_machine, "95 kg", mass)),
        "FILE:4: axis.B.mass: found \"" + mass +
            "\" (beyond all machines: 1e-30 to 1e30 in SI units); expected a value greater than 0 kg (moving mass)");
  EXPECT_EQ(error_of(replaced(small_machine, "95 kg", "1e-30 kg")), "accepted");
}

TEST(MachineFileError, WrongDimensionNamesBoth) {
  EXPECT_EQ(error_after("95 kg", "3 A"),
            "FILE:4: axis.B.mass: found \"3 A\" (dimension A, not kg); expected a value greater than 0 kg (moving "
            "mass)");
  EXPECT_EQ(
      error_after("35 N/V", "35 N/m"),
      "FILE:10: axis.B.motor.force_constant: found \"35 N/m\" (dimension kg s^-2, not m^-1 s A); expected a value "
      "greater than 0 N/V (force constant of the whole motor, amplitude amperes; the unit says what drives a force "
      "source)");
  // A source of amperes has a controller of amperes.
  EXPECT_EQ(error_after("35 N/V", "35 N/A"),
            "FILE:20: axis.B.velocity_controller.gain: found \"243 V s/m\" (dimension m kg s^-2 A^-1, not m^-1 s A); "
            "expected a value greater than 0 A s/m (velocity gain k_pv)");
}

TEST(MachineFileError, MissingUnitUnknownUnitAndWrongType) {
  const std::string expected = "; expected a value greater than 0 kg (moving mass)";
  EXPECT_EQ(error_after("\"95 kg\"", "95"), "FILE:4: axis.B.mass: found 95 (no unit)" + expected);
  EXPECT_EQ(error_after("\"95 kg\"", "\"95\""), "FILE:4: axis.B.mass: found \"95\" (no unit)" + expected);
  EXPECT_EQ(error_after("95 kg", "95 kq"),
            "FILE:4: axis.B.mass: found \"95 kq\" (unknown unit \"kq\"; did you mean \"kg\"?)" + expected);
  EXPECT_EQ(error_after("95 kg", "heavy"), "FILE:4: axis.B.mass: found \"heavy\" (not NUMBER UNIT)" + expected);
  EXPECT_EQ(error_after("95 kg", "nan kg"), "FILE:4: axis.B.mass: found \"nan kg\" (not a finite number)" + expected);
  EXPECT_EQ(error_after("\"95 kg\"", "true"), "FILE:4: axis.B.mass: found true" + expected);
  EXPECT_EQ(error_after("\"95 kg\"", "[\"95 kg\"]"), "FILE:4: axis.B.mass: found a list" + expected);
  EXPECT_EQ(error_after("\"95 kg\"", "{ x = 3 }"), "FILE:4: axis.B.mass: found a table" + expected);
  EXPECT_EQ(error_after("damping_ratio = 0.1", "damping_ratio = inf"),
            "FILE:28: axis.B.friction.lugre.damping_ratio: found inf; expected a number of at least 0 (contact damping "
            "ratio zeta_s)");
}

TEST(MachineFileError, MissingKeyPointsToTheHeaderOfItsTable) {
  EXPECT_EQ(error_after("mass = \"95 kg\"\n", ""),
            "FILE:3: axis.B.mass: found no such key; expected a value greater than 0 kg (moving mass)");
  EXPECT_EQ(error_after("model = \"force\"\n", ""),
            "FILE:8: axis.B.motor.model: found no such key; expected \"synchronous\", \"dc\" or \"force\" (motor "
            "model)");
  EXPECT_EQ(error_after("stiffness = \"1e6 N/m\"\n", ""),
            "FILE:23: axis.B.friction.lugre.stiffness: found no such key; expected a value greater than 0 N/m (contact "
            "stiffness k_s)");
  EXPECT_EQ(error_after("[axis.B.encoder]\nincrement = \"50 nm\"\nvelocity = \"mean-difference\"\n", ""),
            "FILE:3: axis.B.encoder: found no such table; expected [axis.B.encoder] (position encoder)");
  EXPECT_EQ(error_after("name = \"small\"\n", ""),
            "FILE:1: name: found no such key; expected a text (name shown in reports)");
}

TEST(MachineFileError, UnknownKeySuggestsTheNearestAndListsTheKnown) {
  EXPECT_EQ(error_after("model =", "modle ="),
            "FILE:9: axis.B.motor.modle: found an unknown key; expected one of model, phase_resistance, "
            "phase_inductance, mutual_inductance, emf_constant, phase_force_constant, force_constant, pole_pair_pitch, "
            "count, thermal_resistance, thermal_time_constant; did you mean \"model\"?");
  EXPECT_EQ(error_after("name = \"small\"", "name = \"small\"\ncolour = \"red\""),
            "FILE:3: colour: found an unknown key; expected one of schema, name, timing, feed_drive, axis, drive, "
            "expected, experiment, reference");
}

TEST(MachineFileError, UnknownKeyIsFoundAtEveryLevel) {
  const std::string timing = "[timing]\nfast_period = \"62.5 us\"\nperiod = 3\n";
  EXPECT_TRUE(error_of(small_machine + timing).starts_with("FILE:31: timing.period: found an unknown key"));
  const std::string mount = "[axis.B.encoder.mount]\nmas = 3\n";
  EXPECT_TRUE(error_of(small_machine + mount).starts_with("FILE:30: axis.B.encoder.mount.mas: found an unknown key"));
  EXPECT_TRUE(error_after("coulomb", "coulom").starts_with("FILE:24: axis.B.friction.lugre.coulom: found an unknown"));
  EXPECT_TRUE(error_after("friction.lugre]", "friction.lugree]")
                  .starts_with("FILE:23: axis.B.friction.lugree: found an unknown key; expected one of use, "));
  EXPECT_TRUE(error_of(small_machine + "[[reference.square]]\naxis = \"B\"\n")
                  .starts_with("FILE:29: reference.square: found an unknown key; expected one of circle"));
}

TEST(MachineFileError, InvalidTomlNamesTheLine) {
  EXPECT_TRUE(error_after("mass = \"95 kg\"", "mass = 95 kg").starts_with("FILE:4: found invalid TOML: "));
  EXPECT_TRUE(error_after("travel", "mass").starts_with("FILE:5: found invalid TOML: "));
}

TEST(MachineFileError, UnreadableFile) {
  try {
    sim::read_machine("/nowhere/machine.toml");
    FAIL() << "read";
  } catch (const MachineFileError& error) {
    EXPECT_STREQ(error.what(),
                 "/nowhere/machine.toml: found no folder /nowhere; expected a machine file (stiction.machine/1) in it");
  }
}

TEST(MachineFileError, OtherSchema) {
  EXPECT_EQ(error_after("stiction.machine/1", "stiction.machine/2"),
            "FILE:1: schema: found \"stiction.machine/2\"; expected \"stiction.machine/1\"");
  EXPECT_EQ(error_after("schema = \"stiction.machine/1\"\n", ""),
            "FILE:1: schema: found no such key; expected \"stiction.machine/1\"");
}

TEST(MachineFileError, FileWithoutAxis) {
  EXPECT_EQ(error_of("schema = \"stiction.machine/1\"\nname = \"empty\"\n"),
            "FILE:1: axis: found no axis; expected at least one table [axis.NAME], or a table [feed_drive]");
  EXPECT_TRUE(error_of("schema = \"stiction.machine/1\"\nname = \"bad\"\n[axis.\"a.b\"]\n")
                  .starts_with("FILE:3: axis: found the name \"a.b\"; expected a name of letters"));
}

TEST(MachineFileError, PeriodThatDoesNotDivideIsAnsweredWithThoseThatDo) {
  const auto with_timing = [](const std::string& lines) { return error_of(small_machine + "[timing]\n" + lines); };
  EXPECT_EQ(with_timing("slow_period = \"1.01 ms\"\n"),
            "FILE:30: timing.slow_period: found \"1.01 ms\"; expected a multiple of fast_period, 0.0625 ms, such as "
            "1 ms or 1.0625 ms");
  EXPECT_EQ(with_timing("fast_period = \"300 us\"\n"),
            "FILE:29: timing.slow_period: found the default 0.001 s; expected a multiple of fast_period, 0.0003 s, "
            "such as 0.0009 s or 0.0012 s");
  EXPECT_EQ(with_timing("fast_period = \"62.5001 us\"\n"),
            "FILE:30: timing.fast_period: found \"62.5001 us\"; expected a multiple of a nanosecond, 0.001 us, such as "
            "62.5 us or 62.501 us");
  EXPECT_EQ(error_after("\"0 us\"", "\"120 us\""),
            "FILE:12: axis.B.inverter.dead_time: found \"120 us\"; expected a multiple of a quarter of fast_period, "
            "15.625 us, such as 109.375 us or 125 us");
  EXPECT_EQ(with_timing("fast_period = \"1 ms\"\n"), "accepted");
}

TEST(MachineFileError, NotchBeyondTheSampledBand) {
  EXPECT_EQ(error_of_set({"axis.X.notch.frequency=8 kHz"}),
            "--set axis.X.notch.frequency: axis.X.notch.frequency: found \"8 kHz\"; expected a frequency below half "
            "the fast loop's rate, 8000 Hz");
}

TEST(MachineFileError, FrictionInUseNeedsItsTable) {
  EXPECT_EQ(error_after("use = \"lugre\"", "use = \"classical\""),
            "FILE:22: axis.B.friction.use: found \"classical\", of which there is no table; expected the table "
            "[axis.B.friction.classical] too, or a model that has one");
  EXPECT_EQ(error_after("use = \"lugre\"", "use = \"bristle\""),
            "FILE:22: axis.B.friction.use: found \"bristle\"; expected a friction model: \"coulomb_viscous\", "
            "\"classical\", \"linear_ramp\", \"parabolic\", \"lugre\", \"dahl\", \"elasto_plastic\", \"maxwell_slip\" "
            "or \"curve\"");
}

TEST(MachineFileError, FrictionModelNotInUseIsCheckedToo) {
  EXPECT_EQ(error_of(small_machine + "[axis.B.friction.parabolic]\nforce_at_1_m_per_s = \"3 N\"\norder = 0\n"),
            "FILE:31: axis.B.friction.parabolic.order: found 0; expected a number from 1 to 20 (order n of the root)");
}

TEST(MachineFileError, MaxwellSlipListsDifferInLength) {
  const std::string head = small_machine + "[axis.B.friction.maxwell_slip]\nviscous = \"0 N s/m\"\n";
  EXPECT_EQ(error_of(head + "stiffness = [\"1 N/m\", \"2 N/m\"]\nlevel = [\"3 N\"]\n"),
            "FILE:32: axis.B.friction.maxwell_slip.level: found a list of 1; expected a list of 2, as many as "
            "stiffness has");
  EXPECT_EQ(error_of(head + "stiffness = [\"1 N/m\",\n\"2 N\"]\nlevel = [\"3 N\"]\n"),
            "FILE:32: axis.B.friction.maxwell_slip.stiffness[1]: found \"2 N\" (dimension m kg s^-2, not kg s^-2); "
            "expected a value greater than 0 N/m (stiffness of each element)");
  EXPECT_EQ(error_of(head + "stiffness = []\nlevel = []\n"),
            "FILE:31: axis.B.friction.maxwell_slip.stiffness: found a list (empty); expected a list of values greater "
            "than 0 N/m (stiffness of each element)");
  EXPECT_EQ(error_of(head + "stiffness = \"1 N/m\"\nlevel = [\"3 N\"]\n"),
            "FILE:31: axis.B.friction.maxwell_slip.stiffness: found \"1 N/m\"; expected a list of values greater than "
            "0 N/m (stiffness of each element)");
}

TEST(MachineFileError, MotorModelNeedsItsKeys) {
  const std::set<std::string> of_motor{"phase_resistance", "phase_inductance", "mutual_inductance",
                                       "emf_constant",     "pole_pair_pitch",  "force_constant"};
  for (const std::string& key : of_motor) {
    const std::string message = error_of_set({"axis.X.motor." + key + "="});
    EXPECT_NE(message.find(":18: axis.X.motor." + key + ": found no such key; expected a value "), std::string::npos)
        << message;
    if (key != "force_constant") {
      EXPECT_TRUE(message.ends_with(", with motor model \"synchronous\"")) << message;
    }
  }
  for (const std::string key : {"mutual_inductance", "phase_force_constant", "pole_pair_pitch"})
    EXPECT_EQ(error_of_set({"axis.X.motor.model=dc", "axis.X.motor." + key + "="}), "accepted");
  const std::string message = error_of_set({"axis.X.current_controller="});
  EXPECT_TRUE(
      message.ends_with(":12: axis.X.current_controller: found no such key; expected a table (current "
                        "controller; a force motor has none), with motor model \"synchronous\""))
      << message;
}

TEST(MachineFileError, ForceMotorHasNoCurrentController) {
  EXPECT_EQ(error_of(small_machine + "[axis.B.current_controller]\ngain = \"35 V/A\"\n"),
            "FILE:29: axis.B.current_controller: found a table; expected none with motor model \"force\"");
}

TEST(MachineFileError, OverridesOfEveryExperimentAreChecked) {
  const std::string impact = small_machine + "[experiment.impact.axis.B.friction.lugre]\n";
  EXPECT_TRUE(error_of(impact + "coulom = \"3 N\"\n", {.experiment = "circle", .set = {}})
                  .starts_with("FILE:30: experiment.impact.axis.B.friction.lugre.coulom: found an unknown key; "));
  EXPECT_EQ(error_of(impact + "coulomb = \"3 kg\"\n"),
            "FILE:30: experiment.impact.axis.B.friction.lugre.coulomb: found \"3 kg\" (dimension kg, not m kg s^-2); "
            "expected a value greater than 0 N (Coulomb friction F_C)");
  EXPECT_EQ(error_of(small_machine + "[experiment.impact.axis.C]\nmass = \"3 kg\"\n"),
            "FILE:29: experiment.impact.axis.C: found an unknown key; expected one of B");
  EXPECT_EQ(error_of(small_machine + "[experiment.impact.reference]\n"),
            "FILE:29: experiment.impact.reference: found an unknown key; expected one of name, timing, axis, drive, "
            "feed_drive");
  EXPECT_TRUE(error_of(small_machine + "[experiment.imapct.axis.B]\nmass = \"3 kg\"\n")
                  .starts_with("FILE:29: experiment.imapct: found an unknown key; expected one of circle, "));
}

TEST(MachineFileError, RowsOfFrictionMeasurementsAreChecked) {
  const std::string steady = small_machine + "[[reference.steady_friction]]\naxis = \"B\"\n";
  EXPECT_EQ(error_of(steady + "velocity = \"1 m/min\"\ncurrent = \"1.25 A\"\n"), "accepted");
  EXPECT_EQ(
      error_of(steady + "velocity = \"1 m/min\"\n"),
      "FILE:29: reference.steady_friction[0].current: found no such key; expected a value of at least 0 A (current "
      "of the whole axis)");
  const std::string presliding = small_machine + "[[reference.presliding]]\n";
  const std::string values = "force = \"20 N\"\ndisplacement = \"0.3 um\"\n";
  EXPECT_EQ(error_of(presliding + "axis = \"B\"\ndirection = \"opposite\"\n" + values), "accepted");
  EXPECT_EQ(
      error_of(presliding + "axis = \"B\"\ndirection = \"back\"\n" + values),
      "FILE:31: reference.presliding[0].direction: found \"back\"; expected \"same\" or \"opposite\" (direction of "
      "the force)");
  EXPECT_EQ(error_of(presliding + "axis = \"Q\"\ndirection = \"same\"\n" + values),
            "FILE:30: reference.presliding[0].axis: found \"Q\"; expected an axis of this machine: \"B\"");
  EXPECT_EQ(error_of(small_machine + "[reference]\npresliding = 3\n"),
            "FILE:30: reference.presliding: found 3; expected rows [[reference.presliding]]");
}

TEST(MachineFileError, ReferenceRowsAreChecked) {
  const std::string start = small_machine + "[[reference.circle]]\n";
  const std::string values = "feed = \"16 m/min\"\nerror = \"7 um\"\ncurrent = \"3.6 A\"\n";
  EXPECT_EQ(error_of(start + "axis = \"B\"\nsource = \"measured\"\n" + values), "accepted");
  EXPECT_EQ(error_of(start + "axis = \"Q\"\nsource = \"measured\"\n" + values),
            "FILE:30: reference.circle[0].axis: found \"Q\"; expected an axis of this machine: \"B\"");
  EXPECT_EQ(error_of(start + "axis = \"B\"\nsource = \"guessed\"\n" + values),
            "FILE:31: reference.circle[0].source: found \"guessed\"; expected \"measured\" or \"published simulation\" "
            "(where the row comes from)");
  const std::string published = start + "axis = \"B\"\nsource = \"published simulation\"\n";
  EXPECT_TRUE(error_of(published + values)
                  .starts_with("FILE:29: reference.circle[0].friction: found no such key; expected the friction model "
                               "of the published simulation: \"coulomb_viscous\""));
  EXPECT_TRUE(
      error_of(published + "friction = \"bristle\"\n" + values)
          .starts_with("FILE:32: reference.circle[0].friction: found \"bristle\"; expected a friction model: "));
  EXPECT_EQ(error_of(start + "axis = \"B\"\nsource = \"measured\"\nfriction = \"lugre\"\n" + values),
            "FILE:32: reference.circle[0].friction: found \"lugre\"; expected none with source \"measured\"");
  EXPECT_EQ(error_of(start + "axis = \"B\"\nsource = \"measured\"\n" + replaced(values, "16 m/min", "16 mm")),
            "FILE:32: reference.circle[0].feed: found \"16 mm\" (dimension m, not m s^-1); expected a value greater "
            "than 0 m/s (feed along the path)");
}

TEST(MachineFileError, SetNamesItselfAsThePlace) {
  EXPECT_EQ(error_of_set({"axis.X.mass=3 A"}),
            "--set axis.X.mass: axis.X.mass: found \"3 A\" (dimension A, not kg); expected a value greater than 0 kg "
            "(moving mass)");
  EXPECT_EQ(error_of_set({"axis.*.mass=3 A"}),
            "--set axis.*.mass: axis.X.mass: found \"3 A\" (dimension A, not kg); expected a value greater than 0 kg "
            "(moving mass)");
  EXPECT_TRUE(error_of_set({"axis.X.mas=3 kg"}).starts_with("--set axis.X.mas: axis.X.mas: found an unknown key; "));
  EXPECT_EQ(error_of_set({"axis.Q.mass=3 kg"}),
            "--set axis.Q.mass: axis.Q: found an unknown key; expected one of X, Y");
  EXPECT_EQ(
      error_of_set({"reference.circle=3"}),
      "--set reference.circle: reference: found an unknown key; expected one of name, timing, axis, drive, feed_drive");
}

TEST(MachineFileError, SetWithoutKeyOrValue) {
  EXPECT_EQ(error_of_set({"axis.X.mass"}),
            "--set axis.X.mass: found no KEY=VALUE; expected one, such as axis.X.mass=\"230 kg\"");
  EXPECT_EQ(error_of_set({"=3 kg"}), "--set =3 kg: found no KEY=VALUE; expected one, such as axis.X.mass=\"230 kg\"");
  EXPECT_EQ(error_of_set({"axis X=3 kg"}), "--set axis X: found no valid key; expected one such as axis.X.mass");
  EXPECT_EQ(error_of_set({"axis.X.supervision.over_speed="}),
            "--set axis.X.supervision.over_speed: axis.X.supervision: found nothing to remove; expected a key of the "
            "file");
}

TEST(MachineFileError, DamageAnywhereIsAnsweredWithAMachineFileError) {
  for (std::size_t at = 0; at < small_machine.size(); ++at) {
    for (const std::string damage : {"", "\"", "[", "=", "9", "\n"}) {
      const std::string start = small_machine.substr(0, at) + damage;
      const std::string message = error_of(start + small_machine.substr(at + 1));
      EXPECT_TRUE(message == "accepted" || message.starts_with("FILE:")) << message;
      const std::string cut = error_of(start);
      EXPECT_TRUE(cut == "accepted" || cut.starts_with("FILE:")) << cut;
    }
  }
}

// Every key of the axes and of the timing, by the description the reader itself works from.
TEST(MachineFileError, EveryDescribedQuantityRefusesAForeignUnitAndNamesItsKey) {
  // Without its experiments, for each of which the file would be read again.
  const std::string shipped = content_of(test::shipped_machine());
  const test::MachineFileOnDisk axes(shipped.substr(0, shipped.find("\n[experiment.")));
  int quantities = 0;
  for (const TableDescription& table : sim::machine_file_description()) {
    if (table.name.starts_with('[') || table.name.empty()) continue;
    // A drive writes this one; its messages are in compensation_file_test.
    if (table.name.ends_with(".learned")) continue;
    for (const KeyDescription& key : table.keys) {
      if (key.unit.empty()) continue;
      ++quantities;
      const bool axis = table.name.find("axis.NAME") != std::string::npos;
      const std::string in_file = axis ? replaced(table.name, "axis.NAME", "axis.X") : table.name;
      const std::string path = in_file + "." + key.key;
      // A table that the shipped machine does not have is there with its required texts, and one of the drive with its
      // required quantities.
      std::vector<std::string> set;
      for (const KeyDescription& other : table.keys) {
        if (other.fallback != "required") continue;
        if (other.allowed == "a text") set.push_back(in_file + "." + other.key + "=x");
        if (table.name.starts_with("drive.") && !other.unit.empty() && other.key != key.key)
          set.push_back(in_file + "." + other.key + "=10 " + other.unit);
      }
      const auto machine = table.name.starts_with("feed_drive") ? test::shipped_feed_drive() : axes.path();
      // No parameter is an amount of substance.
      auto foreign = set;
      foreign.push_back(path + (key.list ? "=['1 mol']" : "=1 mol"));
      const std::string message = error_of_set(foreign, {}, machine);
      const std::string start = "--set " + path + ": " + path + (key.list ? "[0]" : "") + ": found \"1 mol\"";
      EXPECT_TRUE(message.starts_with(start)) << message;
      EXPECT_NE(message.find(key.text), std::string::npos) << message;
      if (key.expected.find("a whole number") == std::string::npos) {
        EXPECT_NE(message.find("(dimension mol, not "), std::string::npos) << message;
      }
      set.push_back(path + "=1");
      const std::string bare = error_of_set(set, {}, machine);
      if (key.unit != "1" && !key.list) {
        EXPECT_NE(bare.find("found 1 (no unit)"), std::string::npos) << bare;
      }
    }
  }
  EXPECT_GT(quantities, 50);
}

}  // namespace
}  // namespace stiction::machine
