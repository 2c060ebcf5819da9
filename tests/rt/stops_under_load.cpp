// Stops of an axis in motion, by Modbus and by CAN in turn, next to everything that could be in their way: 32
// connections that write 10 000 parameters a second between them, a standard error that nobody reads, a disk that takes
// seconds for each file. Prints of how many stops the nodes' bus or the controller's showed within two ticks of the
// loop. On a kernel with CAN, as root: interfaces vcan0 and vcan1, `stictiond` and `stiction-plant` in $PATH;
// $HELD_FSYNC_LIBRARY: a library to preload, under which fsync() waits as long as the file $HELD_FSYNC is there.
// usage: stops_under_load STOPS
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "tests/rt/kill_list.hpp"
#include "tests/rt/modbus_load.hpp"

namespace stiction::test {
namespace {

constexpr std::int64_t between_writes_ns = 100'000;  // 10 000 a second
constexpr int connections = 30;                      // and the one that stops, and one that waits for the disk
constexpr std::uint16_t velocity_gain = 1004, store = 0, password = 0x5354, controlword = 100;
constexpr std::uint16_t quick_stop = 0x02;
constexpr std::int64_t most_ticks = 2;
constexpr std::int64_t settles_ns = 100 * millisecond_ns, loaded_ns = 20 * millisecond_ns;
constexpr std::int32_t speed_um_s = 10'000;

class Load {
 public:
  Load() {
    for (int i = 0; i < connections; ++i) clients_.emplace_back(modbus_port);
  }
  bool connected() const {
    return std::all_of(clients_.begin(), clients_.end(), [](const auto& client) { return client.connected(); });
  }
  // What is due until now, each connection one request at a time.
  void go_on() {
    const std::int64_t now = now_ns();
    if (due_ns_ == 0) begin_ns_ = due_ns_ = now;
    last_ns_ = now;
    for (std::size_t tried = 0; due_ns_ <= now && tried < clients_.size(); ++tried) {
      auto& client = clients_[next_ = (next_ + 1) % clients_.size()];
      if (!client.idle()) continue;
      client.write(velocity_gain, 240.0F + static_cast<float>(next_));
      due_ns_ += between_writes_ns;
      ++written_;
    }
  }
  void pause() {
    if (due_ns_ != 0) written_in_ns_ += last_ns_ - begin_ns_;
    due_ns_ = 0;
  }
  // While it was not paused.
  double per_second() const {
    return written_in_ns_ == 0 ? 0.0 : static_cast<double>(written_) * 1e9 / static_cast<double>(written_in_ns_);
  }

 private:
  std::vector<ModbusConnection> clients_;
  std::size_t next_ = 0;
  std::int64_t due_ns_ = 0, begin_ns_ = 0, last_ns_ = 0, written_in_ns_ = 0;
  std::uint64_t written_ = 0;
};

struct Count {
  int made = 0, within = 0;
  std::int64_t longest_ticks = 0, longest_ns = 0;
};

// A pipe that takes nothing more.
int blocked_pipe() {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) return -1;
  while (::write(pipe[1], "x", 1) > 0) {
  }
  ::fcntl(pipe[1], F_SETFL, 0);
  return pipe[1];
}

int run(int stops) {
  std::filesystem::create_directories("/tmp/parameters");
  Buses buses(format_of_nodes());
  Process plant(plant_command, "/tmp/plant.log");
  buses.watch(1000 * millisecond_ns, [] { return !text_of("/tmp/plant.log").empty(); });
  const char* library = std::getenv("HELD_FSYNC_LIBRARY");
  const std::string held = "/tmp/held";
  std::ofstream(held).put('1');
  ::setenv("HELD_FSYNC", held.c_str(), 1);
  Process drive(drive_command(), "/tmp/drive.log", blocked_pipe(), library == nullptr ? "" : library);
  if (!buses.watch(5000 * millisecond_ns, [&] { return buses.statusword() != 0; })) {
    std::printf("found no drive; log:\n%s\n", text_of("/tmp/drive.log").c_str());
    return 1;
  }
  Load load;
  ModbusConnection stopping(modbus_port), storing(modbus_port);
  if (!load.connected() || !stopping.connected() || !storing.connected()) {
    std::printf("found no Modbus server for %d connections\n", connections + 2);
    return 1;
  }
  drive.send(SIGUSR1);  // parameters may be written
  buses.watch(100 * millisecond_ns);
  storing.write_register(store, password);
  bool loaded = false;
  buses.set_beside([&] {
    if (loaded) load.go_on();
  });
  std::array<Count, 2> counts;
  std::int32_t speed = speed_um_s;
  for (int stop = 0; stop < stops && !drive.ended(); ++stop) {
    const bool by_modbus = stop % 2 == 0;
    if (!buses.moves(speed, settles_ns)) {
      std::printf("stop %d: the axis was not moved, statusword 0x%04x\n", stop, buses.statusword());
      break;
    }
    speed = -speed;  // to and fro
    // The stop comes anywhere in a tick.
    loaded = true;
    buses.watch(loaded_ns + stop % 10 * millisecond_ns / 10);
    buses.be_silent();
    buses.mark();
    if (by_modbus)
      stopping.write_register(controlword, quick_stop);
    else
      buses.send_word(quick_stop, 3);
    buses.watch(500 * millisecond_ns, [&] { return buses.seen().stop_shown_ns != 0 && stopping.idle(); });
    // Its ramp, and 100 ms of standstill, have nothing to do with it.
    loaded = false;
    load.pause();
    buses.watch(500 * millisecond_ns, [&] { return buses.seen().disabling_ns != 0; });
    const Seen seen = buses.seen();
    if (by_modbus) {  // the stop holds the axis until it is lifted from where it came
      stopping.write_register(controlword, 0x0F);
      buses.watch(500 * millisecond_ns, [&] { return stopping.idle(); });
      buses.watch(5 * millisecond_ns);
    }
    auto& count = counts[by_modbus ? 0 : 1];
    ++count.made;
    if (seen.stop_shown_ns == 0) continue;
    // What a tick has made of a stop is shown behind the SYNC of the one that follows it (run.hpp).
    const std::int64_t ticks = seen.ticks_until(seen.stop_shown_ns) - 1;
    if (ticks <= most_ticks) ++count.within;
    count.longest_ticks = std::max(count.longest_ticks, ticks);
    count.longest_ns = std::max(count.longest_ns, seen.stop_shown_ns - seen.since_ns);
  }
  bool good = buses.lost() == 0 && counts[0].made + counts[1].made == stops && !storing.idle();
  for (const bool by_modbus : {true, false}) {
    const auto& count = counts[by_modbus ? 0 : 1];
    good = good && count.within == count.made && count.made > 0;
    std::printf("stops by %-6s %4d of %d within %lld ticks, longest %lld ticks, %.2f ms\n",
                by_modbus ? "Modbus" : "CAN", count.within, count.made, static_cast<long long>(most_ticks),
                static_cast<long long>(count.longest_ticks), static_cast<double>(count.longest_ns) * 1e-6);
  }
  std::printf("%.0f parameter writes a second by %d connections\n", load.per_second(), connections);
  std::filesystem::remove(held);
  if (!good)
    std::printf("%s; frames lost by this test: %llu\n", storing.idle() ? "the disk has answered" : "",
                static_cast<unsigned long long>(buses.lost()));
  return good ? 0 : 1;
}

}  // namespace
}  // namespace stiction::test

int main(int argc, char** argv) { return stiction::test::run(argc > 1 ? std::atoi(argv[1]) : 20); }
