#include "host/client/device/child_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>

#include "host/client/local/descriptor.hpp"
#include "host/client/local/interruption.hpp"

#include "host/client/device/spawn_actions.hpp"

namespace inkwell::device {
namespace {

constexpr int killed_by = 128;  // a shell also returns this number plus the signal

pid_t spawn(const ChildProgram& program, int output) {
  std::vector<std::string> words = program.words;
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  SpawnActions actions;
  posix_spawn_file_actions_addopen(actions.get(), STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(actions.get(), output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(actions.get(), output, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(actions.get(), program.folder.c_str());
  pid_t child = 0;
  const int code = posix_spawnp(&child, pointers[0], actions.get(), nullptr, pointers.data(), environ);
  if (code != 0)
    throw Error(fmt::format("{} cannot be started: {}. {}", program.words[0], std::strerror(code), program.advice));
  return child;
}

int wait_for(pid_t child) {
  int status = 0;
  local::repeat_interrupted([&] { return waitpid(child, &status, 0); });
  return WIFSIGNALED(status) ? killed_by + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

local::PrivateFolder make_private_folder() {
  try {
    return local::PrivateFolder::for_files();
  } catch (const std::runtime_error& error) {
    throw Error(error.what());
  }
}

int run_child_program(const ChildProgram& program, const std::function<void(std::string_view)>& on_output) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw Error("A pipe cannot be created: too many files are open. Close some programs.");
  const local::Descriptor from_child(ends[0]);
  local::Descriptor to_parent(ends[1]);
  const pid_t child = spawn(program, to_parent.number());
  to_parent = local::Descriptor();
  std::array<char, 4096> chunk;
  for (;;) {
    const ssize_t length =
        local::repeat_interrupted([&] { return read(from_child.number(), chunk.data(), chunk.size()); });
    if (length <= 0) break;
    on_output({chunk.data(), static_cast<std::size_t>(length)});
  }
  return wait_for(child);
}

}  // namespace inkwell::device
