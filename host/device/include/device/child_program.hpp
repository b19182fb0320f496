// Other people's programs that this one runs and waits for, such as gnuplot and openocd. No shell reads their
// arguments.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <device/error.hpp>

namespace inkwell::device {

/// A new folder that only this user can open. It goes away with this object.
class PrivateFolder {
 public:
  /// Throws Error if the system refuses it.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct ChildProgram {
  std::vector<std::string> words;  ///< its name, which is looked for on PATH, and its arguments
  std::filesystem::path folder;    ///< in which it runs
  std::string advice;              ///< sentence for a user whose computer cannot start it
};

/// Runs the program to its end, with nothing on its standard input. `on_output` gets what it prints on standard output
/// and standard error, in pieces. Returns its exit code, or 128 and the signal that ended it. Throws Error if it cannot
/// be started.
int run_child_program(const ChildProgram& program, const std::function<void(std::string_view)>& on_output);

}  // namespace inkwell::device
