#include "host/companion/command_line/program_libraries.hpp"

#include <fcntl.h>
#include <gelf.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>

#include <fmt/format.h>

#include "host/client/local/descriptor.hpp"

namespace inkwell::command_line {
namespace {

/// Libraries that the drop-in libraries replace.
constexpr std::string_view device_libraries[] = {"libHD.so", "libhdPhantom.so"};

std::filesystem::path find_program(const std::string& program) {
  if (program.find('/') != std::string::npos) return program;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const auto file = std::filesystem::path(folder) / program;
    if (access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

void append_needed(Elf* elf, Elf_Scn* section, std::vector<std::string>& names) {
  GElf_Shdr header;
  Elf_Data* data = elf_getdata(section, nullptr);
  if (data == nullptr || gelf_getshdr(section, &header) == nullptr) return;
  GElf_Dyn entry;
  for (int i = 0; gelf_getdyn(data, i, &entry) != nullptr && entry.d_tag != DT_NULL; ++i) {
    if (entry.d_tag != DT_NEEDED) continue;
    if (const char* name = elf_strptr(elf, header.sh_link, entry.d_un.d_val)) names.emplace_back(name);
  }
}

/// Appends the process and all its descendants.
void append_family(pid_t process, std::vector<pid_t>& family) {
  family.push_back(process);
  std::ifstream children(fmt::format("/proc/{0}/task/{0}/children", process));
  for (pid_t child; children >> child;) append_family(child, family);
}

bool is_device_library(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  for (const auto library : device_libraries)
    if (name.starts_with(library)) return true;
  return false;
}

}  // namespace

std::vector<std::string> needed_libraries(const std::string& program) {
  std::vector<std::string> names;
  elf_version(EV_CURRENT);
  const local::Descriptor file(open(find_program(program).c_str(), O_RDONLY | O_CLOEXEC));
  const std::unique_ptr<Elf, int (*)(Elf*)> elf(elf_begin(file.number(), ELF_C_READ, nullptr), elf_end);
  if (elf == nullptr || elf_kind(elf.get()) != ELF_K_ELF) return names;
  for (Elf_Scn* section = nullptr; (section = elf_nextscn(elf.get(), section)) != nullptr;) {
    GElf_Shdr header;
    if (gelf_getshdr(section, &header) != nullptr && header.sh_type == SHT_DYNAMIC)
      append_needed(elf.get(), section, names);
  }
  return names;
}

std::optional<std::filesystem::path> loaded_device_library(pid_t process, const std::filesystem::path& own) {
  std::vector<pid_t> family;
  append_family(process, family);
  std::error_code ignored;
  const auto own_folder = std::filesystem::weakly_canonical(own, ignored);
  std::optional<std::filesystem::path> found;
  for (const pid_t member : family) {
    std::ifstream maps(fmt::format("/proc/{}/maps", member));
    for (std::string line; std::getline(maps, line);) {
      const auto begin = line.find('/');
      if (begin == std::string::npos) continue;
      const std::filesystem::path file = line.substr(begin);
      if (!is_device_library(file)) continue;
      if (file.parent_path() != own_folder) return file;
      found = file;
    }
  }
  return found;
}

bool is_vendor_driver(std::string_view library) {
  constexpr std::string_view vendor[] = {"libPhantomIOLib", "libPHANToMIO", "libPHANTOMIO"};
  for (const auto name : vendor)
    if (library.starts_with(name)) return true;
  return false;
}

}  // namespace inkwell::command_line
