// The parameter file: whole sets only, whatever happens to the power or to the bytes.
#include "firmware/stictiond/parameter_store.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

#include "tests/firmware/stictiond/losing_disk.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using drive::ParametersDamaged;
using drive::ParameterSet;

constexpr const char* store = "/var/lib/stiction/parameters";

// Sets differ in every value, so that a mixed one is none of them; their lengths differ too.
ParameterSet numbered_set(int number) {
  ParameterSet set{"mcfv5050ln", {}};
  for (int key = 0; key < 20 + number % 7; ++key)
    set.values["axis.X.group.key_" + std::to_string(key)] = number + key / 3.0;
  return set;
}

struct Outcome {
  int whole = 0, damaged = 0, lost = 0, mixed = 0;
};

// Writes set after set until the power goes at a random byte or operation, and reads what is left.
template <class Write>
Outcome lose_power(int cuts, Write write) {
  std::mt19937_64 random(20260107);
  LosingDisk whole;
  drive::write_parameters(store, numbered_set(0), drive::KeepAsPrevious::the_file, whole);
  const std::size_t first = whole.steps_done();
  drive::write_parameters(store, numbered_set(1), drive::KeepAsPrevious::the_file, whole);
  const std::size_t one = whole.steps_done() - first;
  Outcome outcome;
  for (int cut = 0; cut < cuts; ++cut) {
    LosingDisk disk;
    drive::write_parameters(store, numbered_set(0), drive::KeepAsPrevious::the_file, disk);
    disk.power_for(random() % (3 * one));
    int done = 0;
    try {
      while (true) {
        write(disk, numbered_set(done + 1));
        ++done;
      }
    } catch (const PowerLost&) {
    }
    disk.power_on(random);
    try {
      const auto found = drive::read_parameters(store, disk);
      if (!found)
        ++outcome.lost;
      else if (*found == numbered_set(done) || *found == numbered_set(done + 1))
        ++outcome.whole;
      else
        ++outcome.mixed;
      // What the cut left lying about does not disturb the next write.
      drive::write_parameters(store, numbered_set(100), drive::KeepAsPrevious::the_file, disk);
      EXPECT_EQ(drive::read_parameters(store, disk), numbered_set(100));
    } catch (const ParametersDamaged&) {
      ++outcome.damaged;
    }
  }
  return outcome;
}

TEST(ParameterStore, KeepsTheOldOrTheNewSetWholeWhereverThePowerGoes) {
  constexpr int cuts = 1000;
  const Outcome outcome = lose_power(cuts, [](LosingDisk& disk, const ParameterSet& set) {
    drive::write_parameters(store, set, drive::KeepAsPrevious::the_file, disk);
  });
  figure("power loss while parameters are written",
         fmt::format("{} cut points: {} whole, {} mixed, {} lost, {} damaged (bound: all whole)", cuts, outcome.whole,
                     outcome.mixed, outcome.lost, outcome.damaged));
  EXPECT_EQ(outcome.whole, cuts);
}

// A disk that takes so many bytes more, as the kernel tells it (ENOSPC); names need none.
class FullDisk : public LosingDisk {
 public:
  void room_for(std::size_t bytes) { room_ = bytes; }
  void append(const std::filesystem::path& file, std::string_view bytes) override {
    LosingDisk::append(file, bytes.substr(0, room_));
    if (bytes.size() > room_) throw std::system_error(std::make_error_code(std::errc::no_space_on_device));
    room_ -= bytes.size();
  }

 private:
  std::size_t room_ = static_cast<std::size_t>(-1);
};

TEST(ParameterStore, TellsThatADiskIsFullWhereverItIsAndKeepsTheSetBefore) {
  const std::size_t size = drive::encode(numbered_set(1)).size();
  std::size_t told = 0, kept = 0;
  for (std::size_t room = 0; room < size; ++room) {
    FullDisk disk;
    drive::write_parameters(store, numbered_set(0), drive::KeepAsPrevious::the_file, disk);
    disk.room_for(room);
    try {
      drive::write_parameters(store, numbered_set(1), drive::KeepAsPrevious::the_file, disk);
    } catch (const std::system_error& error) {
      told += error.code() == std::errc::no_space_on_device ? 1u : 0u;
    }
    kept += drive::read_parameters(store, disk) == numbered_set(0) ? 1u : 0u;
    disk.room_for(static_cast<std::size_t>(-1));
    drive::write_parameters(store, numbered_set(2), drive::KeepAsPrevious::the_file, disk);
    EXPECT_EQ(drive::read_parameters(store, disk), numbered_set(2)) << "when there is room again";
  }
  EXPECT_EQ(told, size);
  EXPECT_EQ(kept, size);
  figure("parameters stored on a disk that is full at any byte of them",
         fmt::format("{} of {} told, {} of {} kept the set before (bound all)", told, size, kept, size));
}

// The first set has none before it: nothing or the set.
TEST(ParameterStore, KeepsNothingOrTheFirstSetWhole) {
  std::mt19937_64 random(7);
  for (int cut = 0; cut < 300; ++cut) {
    LosingDisk disk;
    disk.power_for(random() % 700);
    try {
      drive::write_parameters(store, numbered_set(1), drive::KeepAsPrevious::the_file, disk);
    } catch (const PowerLost&) {
    }
    disk.power_on(random);
    const auto found = drive::read_parameters(store, disk);
    if (!found) continue;
    EXPECT_EQ(*found, numbered_set(1));
  }
}

// Whether the disk above loses anything at all: writers with one step left out are found out.
TEST(ParameterStore, IsTestedOnADiskThatFindsAWriterWithoutSync) {
  const Outcome unsynced = lose_power(1000, [](LosingDisk& disk, const ParameterSet& set) {
    const std::string fresh = std::string(store) + ".new";
    disk.create(fresh);
    disk.append(fresh, drive::encode(set));
    disk.rename(fresh, store);
    disk.sync_folder("");
  });
  EXPECT_GT(unsynced.damaged, 50);
  const Outcome in_place = lose_power(1000, [](LosingDisk& disk, const ParameterSet& set) {
    disk.create(store);
    disk.append(store, drive::encode(set));
    disk.sync(store);
  });
  EXPECT_GT(in_place.damaged, 50);
}

TEST(ParameterStore, WritesAndReadsOnARealDiskAndKeepsTheSetBefore) {
  const auto folder = std::filesystem::temp_directory_path() / ("stiction-store-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto file = folder / "parameters";
  EXPECT_EQ(drive::read_parameters(file), std::nullopt);
  for (int number = 1; number <= 3; ++number) {
    drive::write_parameters(file, numbered_set(number));
    EXPECT_EQ(drive::read_parameters(file), numbered_set(number));
  }
  EXPECT_EQ(drive::read_parameters(drive::previous_of(file)), numbered_set(2));
  std::filesystem::remove_all(folder);
}

// A file that was refused does not take the place of the good set before it, wherever the power goes.
TEST(ParameterStore, KeepsTheGoodSetBeforeWhereTheFileWasRefused) {
  std::mt19937_64 random(7);
  int cut = 0;
  for (int writes = 0; writes < 1000; ++writes) {
    LosingDisk disk;
    drive::write_parameters(store, numbered_set(1), drive::KeepAsPrevious::the_file, disk);
    drive::write_parameters(store, numbered_set(2), drive::KeepAsPrevious::the_file, disk);  // 1 is the set before
    disk.power_for(random() % 600);
    try {
      drive::write_parameters(store, numbered_set(3), drive::KeepAsPrevious::what_is_there, disk);
    } catch (const PowerLost&) {
      ++cut;
    }
    disk.power_on(random);
    EXPECT_EQ(drive::read_parameters(drive::previous_of(store), disk), numbered_set(1));
    const auto found = drive::read_parameters(store, disk);
    EXPECT_TRUE(found == numbered_set(2) || found == numbered_set(3));
  }
  EXPECT_GT(cut, 300);
}

// A file that grows without end is not read into memory.
TEST(ParameterStore, ReadsNoMoreThanASetCanHave) {
  const auto folder = std::filesystem::temp_directory_path() / ("stiction-large-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto file = folder / "parameters";
  std::ofstream(file).put('x');
  std::filesystem::resize_file(file, std::uintmax_t{1} << 33);  // 8 GiB without a block
  EXPECT_LT(drive::system_files().read(file)->size(), std::size_t{2} << 20);
  try {
    drive::read_parameters(file);
    FAIL() << "taken";
  } catch (const ParametersDamaged& error) {
    EXPECT_NE(std::string(error.what()).find("expected at most 1048576"), std::string::npos) << error.what();
  }
  std::filesystem::remove(file);
  std::filesystem::create_symlink("/etc/hostname", file);
  EXPECT_THROW(drive::read_parameters(file), std::system_error) << "a link is not followed";
  std::filesystem::remove_all(folder);
}

TEST(ParameterStore, SaysWhichFileCannotBeWritten) {
  try {
    drive::write_parameters("/nowhere/parameters", numbered_set(1));
    FAIL() << "wrote into a folder that is not there";
  } catch (const std::system_error& error) {
    EXPECT_STREQ(error.what(), "/nowhere/parameters.new: cannot be created: No such file or directory");
  }
}

std::string refusal_of(const std::string& bytes) {
  try {
    drive::decode(bytes, "parameters");
  } catch (const ParametersDamaged& error) {
    return error.what();
  }
  return "taken";
}

TEST(ParameterStore, RefusesEveryDamageOfOneBit) {
  const std::string good = drive::encode(numbered_set(3));
  for (std::size_t byte = 0; byte < good.size(); ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      std::string bad = good;
      bad[byte] = static_cast<char>(bad[byte] ^ (1 << bit));
      // The case of a checksum's digit says nothing: that file is the same set.
      if (std::tolower(bad[byte]) == good[byte]) continue;
      EXPECT_NE(refusal_of(bad), "taken") << "byte " << byte << ", bit " << bit;
    }
}

TEST(ParameterStore, RefusesEveryCutAndWhatIsAppended) {
  const std::string good = drive::encode(numbered_set(3));
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_NE(refusal_of(good.substr(0, size)), "taken");
  EXPECT_NE(refusal_of(good + "x"), "taken");
  EXPECT_EQ(refusal_of(good), "taken");
}

TEST(ParameterStore, SaysWhatWasFoundAndWhatWasExpected) {
  const std::string rest = "; the file is not used. Remove it, or replace it by the previous set: parameters.previous";
  EXPECT_EQ(refusal_of("stiction.parameters/2\n"),
            "parameters:1: found \"stiction.parameters/2\"; expected \"stiction.parameters/1\"" + rest);
  EXPECT_EQ(refusal_of(""),
            "parameters:1: found the end of the file within a line; expected \"stiction.parameters/1\"" + rest);
  const std::string head = "stiction.parameters/1\nlength 10\n";
  EXPECT_EQ(refusal_of(head + "crc32 00000000\nmachine m"),
            "parameters:3: found 9 bytes after this line; expected 10" + rest);
  EXPECT_EQ(refusal_of(head + "crc32 00000000\nmachine m\n"),
            "parameters:3: found the checksum 677cfd10; expected 00000000" + rest);
}

TEST(ParameterStore, StoresOnlyFiniteNumbersUnderNamesWithoutSpaces) {
  EXPECT_THROW(drive::encode({"m", {{"a", std::numeric_limits<double>::quiet_NaN()}}}), std::invalid_argument);
  EXPECT_THROW(drive::encode({"m", {{"a b", 1.0}}}), std::invalid_argument);
  EXPECT_THROW(drive::encode({"", {}}), std::invalid_argument);
}

}  // namespace
}  // namespace stiction::test
