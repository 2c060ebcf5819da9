// One piece of work of the cam tools, repeated; for timing, and for counting instructions from outside.
// usage: cam_work rank|check|table|step|relief TIMES      prints milliseconds each
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "host/cam/rank.hpp"
#include "host/cam/step/lead_in.hpp"
#include "host/cam/step/tolerance.hpp"
#include "sim/cam/check.hpp"
#include "sim/cam/segment_table.hpp"
#include "tests/host/cam/step/step_case.hpp"

int main(int argc, char** argv) {
  using namespace stiction;
  using namespace stiction::host;
  if (argc != 3) return 2;
  sim::cam::RandomMotion random(11);
  const auto motion = sim::cam::compose(random.rests(20));
  AxisLoad load;
  load.load = 0.02;
  load.frequency = 12.0;
  const RankTask task{1.5, std::numbers::pi, 12.0, 9.6, 14.4, std::string(every_task)};
  const auto project = step::relieved_case();
  auto made = step::synthesize(project);
  const std::map<std::string, std::function<void()>> works{
      {"rank", [&] { rank_laws(task, load); }},
      {"check", [&] { jumps_of(motion), duty_of(motion, load, 10.0); }},
      {"table", [&] { table_within(motion, 1e-9 * 4.0); }},
      {"step", [&] { made = step::synthesize(project); }},
      {"relief", [&] { relieve_again(made, project); }},
  };
  const auto work = works.find(argv[1]);
  const int times = std::atoi(argv[2]);
  if (work == works.end() || times < 1) return 2;
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < times; ++k) work->second();
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  std::printf("%s: %.1f ms\n", argv[1], taken.count() / times);
}
