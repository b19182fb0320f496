#include "host/import/child_reader.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/client/installation/installed_paths.hpp"
#include "host/client/local/descriptor.hpp"
#include "host/client/local/interruption.hpp"

#include "host/import/error.hpp"
#include "host/import/pipe_format.hpp"

namespace inkwell::importer {
namespace {

using namespace std::chrono_literals;

struct FileActions {
  FileActions() { posix_spawn_file_actions_init(&actions); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  posix_spawn_file_actions_t actions{};
};

/// A running helper program. The destructor ends it.
class Child {
 public:
  Child(std::vector<std::string> words, int output) {
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    FileActions files;
    posix_spawn_file_actions_addopen(&files.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files.actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&files.actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const int code = posix_spawn(&process_, pointers[0], &files.actions, nullptr, pointers.data(), environ);
    if (code != 0) {
      process_ = 0;
      throw Error(fmt::format("The helper program {} cannot be started: {}. Install Inkwell again.", pointers[0],
                              std::strerror(code)));
    }
  }
  ~Child() {
    if (process_ == 0) return;
    ::kill(process_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Returns the status of waitpid().
  int wait() {
    int status = 0;
    local::repeat_interrupted([&] { return waitpid(process_, &status, 0); });
    process_ = 0;
    return status;
  }

 private:
  pid_t process_ = 0;
};

/// Reads until the child closes the pipe.
std::vector<std::byte> read_message(int pipe, const std::string& name, const ChildLimits& limits,
                                    const Progress& progress) {
  const auto deadline = std::chrono::steady_clock::now() + limits.wall_time;
  std::vector<std::byte> message;
  std::array<std::byte, 1 << 16> piece;
  for (;;) {
    if (progress && !progress(0)) throw Error(fmt::format("The import of {} was canceled.", name));
    if (std::chrono::steady_clock::now() > deadline)
      throw Error(
          fmt::format("The import of {} takes longer than {} s. Check the drive of the file, or export the "
                      "object as STL.",
                      name, limits.wall_time.count()));
    pollfd readable{pipe, POLLIN, 0};
    constexpr auto progress_interval = 50ms;
    const int ready = local::repeat_interrupted(progress_interval, [&](std::chrono::milliseconds rest) {
      return ::poll(&readable, 1, static_cast<int>(rest.count()));
    });
    if (ready == 0) continue;
    const auto count = local::repeat_interrupted([&] { return ::read(pipe, piece.data(), piece.size()); });
    if (count <= 0) return message;
    message.insert(message.end(), piece.begin(), piece.begin() + count);
    if (message.size() > message_bytes_max) check_counts(0, triangles_max + 1, name);
  }
}

}  // namespace

FileContent read_in_child(const std::filesystem::path& file, Format format, const ChildLimits& limits,
                          const Progress& progress) {
  const std::string name = file.filename().string();
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Error(fmt::format("{} cannot be read: {}. Close other programs.", name, std::strerror(errno)));
  const local::Descriptor output(ends[0]);
  local::Descriptor input(ends[1]);
  Child child(
      {installation::import_helper().string(), std::string(key_of(format)), std::filesystem::absolute(file).string(),
       std::to_string(limits.memory_bytes), std::to_string(limits.processor_time.count())},
      input.number());
  input = local::Descriptor();
  const auto message = read_message(output.number(), name, limits, progress);
  const int status = child.wait();
  const bool has_exited = WIFEXITED(status);
  if (!has_exited && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    throw Error(
        fmt::format("The import of {} needs more than {} s of processor time. Reduce the object in a mesh "
                    "editor, or export it as STL.",
                    name, limits.processor_time.count()));
  if (!has_exited || message.empty())
    throw Error(
        fmt::format("The library that reads {} files failed on {}, so the file is damaged or unusual. Export the "
                    "object as STL.",
                    name_of(format), name));
  return decode(message, name);
}

}  // namespace inkwell::importer
