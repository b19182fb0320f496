// Reads scope samples directly into numpy arrays, and controls recordings and test pulses.
#include <algorithm>

#include <pybind11/numpy.h>

#include "host/bindings/python/arm.hpp"

namespace inkwell::python {

void Arm::select_signals(const std::vector<std::string>& names) {
  const Use arm(*this);
  std::vector<const char*> pointers;
  for (const auto& name : names) pointers.push_back(name.c_str());
  call([&] {
    const std::lock_guard lock(scope_mutex_);
    const auto result = inkwell_select_signals(arm, pointers.data(), pointers.size());
    if (result == INKWELL_OK) signal_count_ = pointers.size();
    return result;
  });
}

py::tuple Arm::read_scope(std::size_t rows, double timeout_s, bool fill) {
  std::size_t columns;
  {
    const Use arm(*this);
    const process::CancellationGuard guard;
    const py::gil_scoped_release unlocked;
    const std::lock_guard lock(scope_mutex_);
    columns = signal_count_;
  }
  py::array_t<float> values({rows, std::max<std::size_t>(columns, 1)});
  py::array_t<std::int64_t> periods(static_cast<py::ssize_t>(rows));
  float* const to = values.mutable_data();
  std::int64_t* const to_periods = periods.mutable_data();
  std::size_t count = 0;
  std::uint64_t lost = 0;
  bool timed_out = false, changed = false;
  while (!timed_out && count < rows) {
    try {
      call_patiently(timeout_s, [&](inkwell_arm* arm, double time_s) {
        const std::lock_guard lock(scope_mutex_);
        changed = signal_count_ != columns;
        if (changed) return INKWELL_REFUSED;
        std::size_t read = 0;
        std::uint64_t lost_before = 0;
        const auto result = inkwell_read_samples(arm, time_s, to + count * columns, to_periods + count, rows - count,
                                                 &read, &lost_before);
        count += read;
        lost += lost_before;
        return result == INKWELL_OK && read == 0 ? INKWELL_TIMED_OUT : result;
      });
    } catch (py::error_already_set& error) {
      if (changed)
        raise(INKWELL_REFUSED, "Other signals were selected while samples were read. Read the samples again.");
      timed_out = error.matches(PyExc_TimeoutError);
      if (!timed_out) throw;
      if (fill)
        raise(INKWELL_TIMED_OUT,
              py::str(
                  "Of {} samples {} arrived, then none for {:g} s. Reset the board, or let a paused virtual board run.")
                  .format(rows, count, timeout_s));
    }
    if (!fill) break;
  }
  const py::slice read(0, static_cast<py::ssize_t>(count), 1);
  return py::make_tuple(values[read], periods[read], lost);
}

void Arm::start_recording(const std::string& path) {
  const Use arm(*this);
  call([&] { return inkwell_start_recording(arm, path.c_str()); });
}

std::tuple<std::uint64_t, std::uint64_t, bool> Arm::finish_recording() {
  const Use arm(*this);
  std::uint64_t samples = 0, lost = 0;
  int is_complete = 0;
  call([&] { return inkwell_finish_recording(arm, &samples, &lost, &is_complete); });
  return {samples, lost, is_complete != 0};
}

void Arm::describe_recordings(const std::string& name, const std::string& note) {
  const Use arm(*this);
  call([&] { return inkwell_describe_recordings(arm, name.c_str(), note.c_str()); });
}

void Arm::mark(const std::string& text) {
  const Use arm(*this);
  call([&] { return inkwell_mark(arm, text.c_str()); });
}

// ---- losses, test pulses -----------------------------------------------------------------------------------

inkwell_losses Arm::losses() {
  const Use arm(*this);
  inkwell_losses losses{};
  call([&] { return inkwell_get_losses(arm, &losses); });
  return losses;
}

void Arm::send_test_pulse(int motor, const std::string& unit, double amplitude, double duration_s) {
  const Use arm(*this);
  call([&] {
    return inkwell_send_test_pulse(arm, motor, unit == "V" ? INKWELL_PULSE_V : INKWELL_PULSE_A, amplitude, duration_s);
  });
}

}  // namespace inkwell::python
