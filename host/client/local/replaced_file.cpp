#include "host/client/local/replaced_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include <fmt/format.h>

#include "host/client/local/descriptor.hpp"
#include "host/client/local/interruption.hpp"

namespace inkwell::local {
namespace {

namespace fs = std::filesystem;

std::system_error failure_at(const fs::path& path) { return {errno, std::generic_category(), path.string()}; }

void write_all(const fs::path& file, int flags, std::string_view content) {
  Descriptor written(repeat_interrupted([&] { return ::open(file.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666); }));
  if (!written.is_open()) throw failure_at(file);
  while (!content.empty()) {
    const ssize_t count = repeat_interrupted([&] { return ::write(written.number(), content.data(), content.size()); });
    if (count <= 0) throw failure_at(file);
    content.remove_prefix(static_cast<std::size_t>(count));
  }
}

}  // namespace

fs::path resolve_symbolic_links(fs::path path) {
  constexpr int symbolic_links_maximum = 40;  // limit of Linux
  std::error_code code;
  for (int i = 0; i < symbolic_links_maximum && fs::is_symlink(path, code); ++i) {
    const fs::path target = fs::read_symlink(path, code);
    if (code) break;
    path = path.parent_path() / target;
  }
  return path;
}

ReplacedFile::ReplacedFile(const fs::path& file)
    : file_(resolve_symbolic_links(file)),
      path_(file_.parent_path() /
            fmt::format("{}.{}.part{}", file_.stem().string(), ::getpid(), file_.extension().string())) {
  std::error_code ignored;
  fs::remove(path_, ignored);  // of a killed program that had the same process number
}

ReplacedFile::~ReplacedFile() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

void ReplacedFile::replace() {
  struct stat older {};
  if (::stat(file_.c_str(), &older) == 0) {
    const bool has_owner = ::chown(path_.c_str(), older.st_uid, older.st_gid) == 0;
    constexpr mode_t rights = 0777, set_user_and_group = 06000;
    // The bits for another owner must not apply to this user.
    if (::chmod(path_.c_str(), older.st_mode & (has_owner ? rights | set_user_and_group : rights)) != 0)
      throw failure_at(file_);
  }
  if (::rename(path_.c_str(), file_.c_str()) != 0) throw failure_at(file_);
}

void replace_file(const fs::path& file, std::string_view content) {
  struct stat older {};
  if (::stat(file.c_str(), &older) == 0 && !S_ISREG(older.st_mode)) {
    write_all(file, O_NOCTTY, content);
    return;
  }
  ReplacedFile next(file);
  write_all(next.path(), O_CREAT | O_EXCL, content);
  next.replace();
}

}  // namespace inkwell::local
