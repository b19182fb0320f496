#include "host/client/installation/installed_paths.hpp"

#include <dlfcn.h>

#include <string_view>
#include <system_error>

namespace inkwell::installation {
namespace {

std::filesystem::path own_folder() {
  std::error_code code;
  // For the program itself, the loader provides only the name from the command line.
  Dl_info here{};
  if (dladdr(reinterpret_cast<void*>(&own_folder), &here) != 0 && here.dli_fname != nullptr &&
      std::string_view(here.dli_fname).find(".so") != std::string_view::npos) {
    const auto library = std::filesystem::canonical(here.dli_fname, code);
    if (!code) return library.parent_path();
  }
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", code);
  return code ? std::filesystem::current_path() : executable.parent_path();
}

}  // namespace

std::filesystem::path prefix() {
  const auto own = own_folder();
  std::error_code code;
  for (auto folder = own;; folder = folder.parent_path()) {
    if (std::filesystem::exists(folder / INKWELL_ARMS_PATH, code)) return folder;
    if (folder == folder.parent_path()) return own;
  }
}

std::filesystem::path virtual_board() { return prefix() / INKWELL_PROGRAMS_PATH / "virtual-board"; }
std::filesystem::path firmware(const std::string& image) { return prefix() / INKWELL_FIRMWARE_PATH / image; }
std::filesystem::path default_arm() { return prefix() / INKWELL_ARMS_PATH / "omni.toml"; }
std::filesystem::path dropins() { return prefix() / INKWELL_DROPINS_PATH; }
std::filesystem::path import_helper() { return prefix() / INKWELL_HELPERS_PATH / "inkwell-import"; }

}  // namespace inkwell::installation
