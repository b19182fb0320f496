// The commands of the `inkwell` program. Each adds itself to the program's options and, if it was chosen, runs.
#pragma once

#include <functional>

#include "connection.hpp"

namespace inkwell::command_line {

/// What is to be done once the options are read; returns the exit code.
using Action = std::function<int()>;
/// Opens the window, on a recording unless its name is empty; returns the exit code.
using OpenWindow = std::function<int(const std::filesystem::path& recording)>;

void add_info_command(CLI::App& program, const DeviceOptions& options, Action& action);
void add_watch_command(CLI::App& program, const DeviceOptions& options, Action& action);
void add_parameters_command(CLI::App& program, const DeviceOptions& options, Action& action);
void add_experiment_command(CLI::App& program, const DeviceOptions& options, Action& action);
void add_record_command(CLI::App& program, const DeviceOptions& options, Action& action);
void add_replay_command(CLI::App& program, const DeviceOptions& options, const OpenWindow& open_window, Action& action);
void add_plot_command(CLI::App& program, const DeviceOptions& options, Action& action);
void add_calibrate_command(CLI::App& program, const DeviceOptions& options, Action& action);
void add_tune_command(CLI::App& program, const DeviceOptions& options, Action& action);
void add_check_command(CLI::App& program, const DeviceOptions& options, Action& action);
/// Without a command the window opens. Returns what opens it for a command, with the same options.
OpenWindow add_window_options(CLI::App& program, const DeviceOptions& options, Action& action);

}  // namespace inkwell::command_line
