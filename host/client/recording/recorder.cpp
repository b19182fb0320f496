#include "host/client/recording/recorder.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

namespace inkwell::recording {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t queue_bytes_maximum = 64u << 20;
/// A crash loses at most half a second: this interval plus one chunk of the file (hdf5_writer.cpp).
constexpr auto flush_interval = 300ms;

std::size_t size_of(const device::ScopeSamples& samples) {
  return samples.values.size() * sizeof(float) + sizeof samples;
}

/// A device does not send simulated quantities.
Information only_signals(Information information) {
  information.simulated.clear();
  return information;
}

}  // namespace

struct Recorder::Implementation {
  using Item = std::variant<device::ScopeSamples, Mark, ClockReading>;

  Implementation(const std::filesystem::path& path, const Information& about)
      : file(path), information(about), writer(create(path, about)), thread([this] { write_all(); }) {}

  void write_all() {
    auto next_flush = std::chrono::steady_clock::now() + flush_interval;
    std::unique_lock lock(mutex);
    for (;;) {
      wake.wait_until(lock, next_flush, [this] { return stopping || !queue.empty(); });
      std::deque<Item> items;
      items.swap(queue);
      queued_bytes = 0;
      const bool last = stopping;
      const bool is_complete = status.lost == 0 && status.error.empty() && !misses_end;
      const bool flush_now = std::chrono::steady_clock::now() >= next_flush;
      lock.unlock();
      try {
        for (const auto& item : items) write(item);
        if (flush_now) {
          writer->flush();
          next_flush = std::chrono::steady_clock::now() + flush_interval;
        }
        if (last) writer->end(is_complete);
      } catch (const device::Error& problem) {
        lock.lock();
        status.error = fmt::format("{} At most the last half second before this error is missing from the recording.",
                                   problem.what());
        status.running = false;
        return;
      }
      lock.lock();
      update_sizes();
      if (last) {
        status.is_complete = is_complete;
        status.running = false;
        return;
      }
    }
  }
  void write(const Item& item) {
    if (const auto* mark = std::get_if<Mark>(&item)) return writer->mark(*mark);
    if (const auto* reading = std::get_if<ClockReading>(&item)) return writer->clock(*reading);
    writer->append(std::get<device::ScopeSamples>(item), {});
  }
  void update_sizes() {
    std::error_code error;
    if (const auto size = std::filesystem::file_size(file, error); !error) status.bytes = size;
    const auto space = std::filesystem::space(std::filesystem::absolute(file).parent_path(), error);
    if (!error) status.free_bytes = space.available;
  }

  std::filesystem::path file;
  Information information;
  std::unique_ptr<Writer> writer;

  std::mutex mutex;
  std::condition_variable wake;
  std::deque<Item> queue;
  std::size_t queued_bytes = 0;
  bool stopping = false, misses_end = false;
  RecorderStatus status{.running = true};
  std::optional<std::int64_t> first_period;
  std::int64_t newest_period = 0;
  std::int64_t next_clock_period = 0;
  std::vector<Mark> early_marks;  ///< marks before the first sample, assigned to the first sample

  std::thread thread;  // last member, so that the thread starts after all others exist
};

Recorder::Recorder(const std::filesystem::path& file, const Information& information)
    : implementation_(std::make_unique<Implementation>(file, only_signals(information))) {}

Recorder::~Recorder() { stop(); }

void Recorder::push(const device::ScopeSamples& samples) {
  auto& self = *implementation_;
  const std::lock_guard lock(self.mutex);
  if (!self.status.running || self.stopping || samples.signals != self.information.signals || samples.count == 0)
    return;
  const std::int64_t step = samples.first_period - self.newest_period;
  if (self.first_period && step <= 0) {
    self.status.error =
        "The board restarted, so its time restarted too. The recording stops at the last sample before the restart.";
    self.stopping = true;
    self.wake.notify_one();
    return;
  }
  // The loss is computed from the periods, so it includes samples lost between the link and this function.
  if (self.first_period) self.status.lost += static_cast<std::uint64_t>(step - 1);
  if (self.queued_bytes + size_of(samples) > queue_bytes_maximum) return;  // counted as lost by the next block
  const bool is_first = !self.first_period;
  if (is_first) self.first_period = samples.first_period;
  self.newest_period = samples.first_period + static_cast<std::int64_t>(samples.count) - 1;
  self.status.samples += samples.count;
  self.status.duration_s = device::board_time_s(self.newest_period - *self.first_period);
  self.queued_bytes += size_of(samples);
  self.queue.emplace_back(samples);
  if (is_first || self.newest_period >= self.next_clock_period) {
    using namespace std::chrono;
    const auto now = time_point_cast<microseconds>(system_clock::now());
    self.queue.emplace_back(ClockReading{self.newest_period, now.time_since_epoch().count()});
    self.next_clock_period = self.newest_period + protocol::servo_rate_Hz;
  }
  if (is_first)
    for (Mark& mark : self.early_marks) {
      mark.period = samples.first_period;
      self.queue.emplace_back(std::move(mark));
    }
  self.wake.notify_one();
}

void Recorder::mark(const std::string& text) { note(device::event_now(device::EventKind::mark, text, std::nullopt)); }

void Recorder::note(const device::Event& event) {
  auto& self = *implementation_;
  const std::lock_guard lock(self.mutex);
  if (!self.status.running || self.stopping) return;
  ++self.status.marks;
  Mark mark{event.at_periods.value_or(self.newest_period), event.text, event.kind, event.clock_utc};
  if (!self.first_period) return self.early_marks.push_back(std::move(mark));
  mark.period = std::max(mark.period, *self.first_period);
  self.queue.emplace_back(std::move(mark));
  self.wake.notify_one();
}

void Recorder::miss_end() {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->misses_end = true;
}

RecorderStatus Recorder::status() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->status;
}

RecorderStatus Recorder::stop() {
  auto& self = *implementation_;
  {
    const std::lock_guard lock(self.mutex);
    self.stopping = true;
  }
  self.wake.notify_one();
  if (self.thread.joinable()) self.thread.join();
  return status();
}

}  // namespace inkwell::recording
