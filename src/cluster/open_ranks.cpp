#include "cluster/open_ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/errors.h"
#include "cluster/mpi_module.h"

namespace catoptric::cluster {
namespace {

/// A process without others.
class Alone : public Messenger {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  int size_here() const override { return 1; }
  void send(int, Topic, const Bytes&) override {}
  std::optional<Message> look() override { return std::nullopt; }
  void abort(int) override {}
};

int number(const char* variable) {
  const char* text = std::getenv(variable);
  if (!text) return 0;
  int value = 0;
  std::from_chars(text, text + std::string_view(text).size(), value);
  return value;
}

/// Beside the program where it was built, in lib/catoptric where it was installed.
std::filesystem::path module_path() {
  std::error_code unknown;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
  for (const auto& place : {folder, folder.parent_path() / CATOPTRIC_MODULE_FOLDER})
    if (const auto file = place / mpi_module_name; std::filesystem::exists(file, unknown)) return file;
  return {};
}

[[noreturn]] void refuse(const std::string& why) {
  throw UsageError({fmt::format("{} processes were started and cannot find each other", launched_processes()),
                    "command line", why,
                    "start catoptric without mpirun, or install libopenmpi-dev and build it again"});
}

/// Stays loaded to the end: MPI cannot be begun twice.
OpenMessenger opener() {
  const std::filesystem::path file = module_path();
  if (file.empty())
    refuse(fmt::format("there is no {} beside this program: it was built without MPI", mpi_module_name));
  // MPI's own plug-ins look for its symbols among all.
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (!module) refuse(::dlerror());
  void* symbol = ::dlsym(module, mpi_module_symbol);
  if (!symbol) refuse(fmt::format("{} is of another version of this program", file.string()));
  return reinterpret_cast<OpenMessenger>(symbol);
}

}  // namespace

int launched_processes() {
  // Open MPI and PRRTE; Slurm's srun with PMIx or PMI-2; MPICH's Hydra.
  int processes = std::max({1, number("OMPI_COMM_WORLD_SIZE"), number("PMI_SIZE")});
  if (processes == 1 && (std::getenv("PMIX_RANK") || std::getenv("PMI_RANK")))
    processes = std::max(1, number("SLURM_NTASKS"));
  return processes;
}

std::unique_ptr<SharedRanks> open_ranks() {
  if (launched_processes() == 1) return std::make_unique<SharedRanks>(std::make_unique<Alone>());
  return std::make_unique<SharedRanks>(std::unique_ptr<Messenger>(opener()()));
}

}  // namespace catoptric::cluster
