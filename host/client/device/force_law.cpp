#include "host/client/device/force_law.hpp"

#include <algorithm>
#include <cstring>
#include <list>
#include <mutex>
#include <string_view>

#include "host/client/device/error.hpp"
#include "host/client/process/fork.hpp"
#include "protocol/plain_text.hpp"

namespace inkwell::device {
namespace {

Error damaged() {
  return Error("The device's description of its force law is damaged. Build its firmware again and flash it.");
}

class RowReader {
 public:
  explicit RowReader(std::span<std::byte> left) : left_(left) {}

  float number() {
    float value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  /// Returns a zero-terminated text. Replaces unprintable characters in the report.
  std::string_view text() {
    auto* begin = reinterpret_cast<char*>(left_.data());
    const std::size_t length = strnlen(begin, left_.size());
    take(length + 1);
    std::ranges::copy(protocol::plain_text({begin, length}), begin);
    return {begin, length};
  }
  /// Allows only letters, digits and underscores, because the name is used in files and plot scripts.
  std::string_view name() {
    const auto name = text();
    const auto is_allowed = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    if (name.empty() || !std::ranges::all_of(name, is_allowed)) throw damaged();
    return name;
  }
  template <class Row>
  void texts_of(Row& row) {
    row.name = name();
    row.unit = text();
    row.help = text().data();
  }

 private:
  std::span<std::byte> take(std::size_t size) {
    if (size > left_.size()) throw damaged();
    const auto taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }

  std::span<std::byte> left_;
};

/// Never destroyed, because other threads may read these rows at any time.
struct Joined {
  ForceLaw law;
  std::span<const protocol::ParameterInfo> parameters;
  std::span<const protocol::SignalInfo> signals;
};

std::mutex joined_mutex;
const process::HeldAtFork joined_at_fork(joined_mutex);
std::list<Joined> joined;                                        // the last entry is in the tables
std::vector<std::weak_ptr<const std::vector<std::byte>>> users;  // users of the law that is in the tables

/// Adds the rows of `law` to the tables. Null removes the added rows.
void show(const Joined* law) {
  protocol::added_rows<protocol::ParameterInfo>.store(law ? &law->parameters : nullptr, std::memory_order_release);
  protocol::added_rows<protocol::SignalInfo>.store(law ? &law->signals : nullptr, std::memory_order_release);
}

}  // namespace

ForceLaw parse_force_law(std::span<const std::byte> report) {
  protocol::ForceLawReport head{};
  if (report.size() >= sizeof head) std::memcpy(&head, report.data(), sizeof head);
  if (head.size < sizeof head || head.size > report.size() ||
      head.parameter_count > protocol::force_law_parameters_maximum ||
      head.signal_count > protocol::force_law_signals_maximum)
    throw damaged();
  const auto bytes = std::make_shared<std::vector<std::byte>>(report.begin(), report.begin() + head.size);
  RowReader reader{std::span(*bytes).subspan(sizeof head)};
  ForceLaw law{.report = bytes, .name = reader.text(), .help = reader.text(), .parameters = {}, .signals = {}};
  for (std::size_t i = 0; i < head.parameter_count; ++i) {
    protocol::ParameterInfo row{};
    row.id = static_cast<std::uint16_t>(protocol::force_law_first_id + i);
    row.kind = protocol::ParameterKind::real;
    row.minimum = reader.number();
    row.maximum = reader.number();
    row.default_value = reader.number();
    reader.texts_of(row);
    row.group = "force law";
    law.parameters.push_back(row);
  }
  for (std::size_t i = 0; i < head.signal_count; ++i) {
    protocol::SignalInfo row{};
    row.id = static_cast<std::uint8_t>(protocol::signal_count + i);
    row.wire = protocol::SignalWire::float32;
    reader.texts_of(row);
    law.signals.push_back(row);
  }
  return law;
}

bool join_tables(const ForceLaw& law) {
  const std::lock_guard lock(joined_mutex);
  std::erase_if(users, [](const auto& user) { return user.expired(); });
  if (law.parameters.empty() && law.signals.empty()) {
    if (users.empty()) show(nullptr);
    return true;
  }
  if (joined.empty() || *joined.back().law.report != *law.report) {
    if (!users.empty()) return false;
    // The tables need a separate copy of the texts.
    auto& fresh = joined.emplace_back(Joined{parse_force_law(*law.report), {}, {}});
    fresh.parameters = fresh.law.parameters;
    fresh.signals = fresh.law.signals;
  }
  show(&joined.back());
  users.emplace_back(law.report);
  return true;
}

std::string joined_force_law() {
  const std::lock_guard lock(joined_mutex);
  const bool is_shown = protocol::added_rows<protocol::ParameterInfo>.load(std::memory_order_acquire) != nullptr;
  return is_shown ? std::string(joined.back().law.name) : std::string();
}

}  // namespace inkwell::device
