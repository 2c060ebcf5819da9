// `stiction sweep`: many runs over a grid or a sample, on threads, MPI ranks or tasks of a batch system.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <thread>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/whole_file.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/cli/sweep_output.hpp"
#include "host/cli/temporaries.hpp"
#include "host/report/experiment_report.hpp"
#include "host/sweep/results.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct SweepOptions {
  std::string spec;
  std::string out;
  int threads = 0;
  bool yes = false;
  std::string slurm;
  int tasks = 8;
  bool json = false;
};

// Number and count of this process among those that one launcher started.
struct LaunchedAs {
  unsigned rank = 0, count = 1;
  bool launched = false;
};

std::optional<unsigned> number_in(const char* variable) {
  const char* text = std::getenv(variable);
  if (text == nullptr || *text == '\0') return std::nullopt;
  char* end = nullptr;
  const auto number = std::strtoul(text, &end, 10);
  if (*end != '\0' || number > 1'000'000) return std::nullopt;
  return static_cast<unsigned>(number);
}

// As Open MPI, MPICH and Slurm tell it in the environment. Nothing else is needed of them: the processes meet in the
// folder of the results.
LaunchedAs launched_as() {
  constexpr std::array<std::array<const char*, 2>, 4> names{{{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                                             {"PMI_RANK", "PMI_SIZE"},
                                                             {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT"},
                                                             {"SLURM_PROCID", "SLURM_NTASKS"}}};
  for (const auto& [rank, count] : names)
    if (const auto number = number_in(rank)) return {*number, std::max(number_in(count).value_or(1), 1U), true};
  return {};
}

unsigned threads_of(const SweepOptions& options, const LaunchedAs& launched) {
  if (options.threads > 0) return static_cast<unsigned>(options.threads);
  if (const auto given = number_in("SLURM_CPUS_PER_TASK")) return std::max(*given, 1U);
  return launched.launched ? 1U : std::max(std::thread::hardware_concurrency(), 1U);
}

SweepSpec read_spec(const std::string& name) {
  const auto file = find_sweep(name);
  return parse_sweep_spec(file.string(), machine::read_whole_file(file, "the specification of a sweep"));
}

// The results, the table last: it says that they are complete.
void write_results(const SweepSpec& spec, const SweepCommand& command, const SweepPlan& plan, const SweepFolder& folder,
                   const Invocation& invocation) {
  const SweepRows rows(spec, command);
  const auto files = chunk_files(folder, plan);
  const auto summary = summarize(spec, rows, plan, files);
  const auto result = sweep_result(spec, plan, summary);
  const auto machine_name = rows.row(0).machine;
  put_file(folder.path() / "sweep.json", sweep_json(spec, plan, summary).dump(2) + "\n");
  put_file(folder.path() / "report.html",
           experiment_report_html({invocation.command_line, invocation.version,
                                   sim::read_machine(machine::find_machine(machine_name)), result,
                                   report_origin(machine_name, std::vector<std::string>{spec.file})}));
  write_table(spec, rows, plan, files, folder.table());
  files.remove_all();
}

void write_job(const SweepOptions& options) {
  PendingFile file(options.slurm);
  file.write(slurm_script({options.spec, options.out, options.tasks, std::max(options.threads, 1), options.yes}));
  file.commit();
  fmt::print("job: {0}\nsubmit it with: sbatch {0}\n", options.slurm);
}

void run(const SweepOptions& options, const Invocation& invocation) {
  const auto spec = read_spec(options.spec);
  const auto& command = command_of(spec);
  if (!options.slurm.empty()) return write_job(options);
  const SweepFolder folder(options.out);
  const auto launched = launched_as();
  const bool speaks = launched.rank == 0;
  say_when_interrupted(
      speaks ? fmt::format("stiction: interrupted; the same command resumes the sweep in {}\n", options.out)
             : std::string());
  SweepSettings settings;
  settings.version = invocation.version;
  settings.threads = threads_of(options, launched);
  settings.processes = launched.count;
  settings.yes = options.yes;
  SweepPlan plan;
  {
    Progress progress("runs", speaks ? spec.rows() : 0, speaks);
    settings.progress = [&](std::uint64_t done, std::uint64_t) { progress.reach(done); };
    plan = run_sweep(spec, command, folder, settings);
  }
  finish_once(folder, [&] { write_results(spec, command, plan, folder, invocation); });
  say_when_interrupted({});
  if (!speaks) return;
  const auto text = machine::read_whole_file(folder.path() / "sweep.json", "the summary of a sweep");
  fmt::print("{}", options.json ? text : sweep_text(text));
  if (!options.json) fmt::print("\ntable: {0}/sweep.npz\nreport: {0}/report.html\n", options.out);
}

}  // namespace

void add_sweep(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand(
      "sweep",
      "run a command many times over a grid or a sample of keys; it resumes, and several processes may share it");
  auto o = std::make_shared<SweepOptions>();
  command->add_option("spec", o->spec, "shipped sweep by name, or a specification (TOML)")
      ->required()
      ->type_name("SPEC");
  command
      ->add_option("--out", o->out,
                   "folder of sweep.npz, sweep.json and report.html; of a sweep that was interrupted, to resume it")
      ->required()
      ->type_name("DIR");
  command->add_option("--threads", o->threads, "threads of this process [all processors; one for each MPI rank]")
      ->check(whole_number_between(1, 1024))
      ->type_name("N");
  command->add_flag("--yes", o->yes, "begin also what takes longer than ten minutes");
  add_output_file(*command, "--slurm", o->slurm,
                  "run nothing, but write the script of a Slurm array job into this file");
  command->add_option("--tasks", o->tasks, "tasks of that job, which share the sweep")
      ->check(whole_number_between(1, 100000))
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--json", o->json, "print the summary as JSON on standard output");
  command->callback([o, &invocation] {
    try {
      run(*o, invocation);
    } catch (const machine::UnreadableFile& error) {
      throw UsageError(error.what());
    }
  });
}

}  // namespace stiction::host
