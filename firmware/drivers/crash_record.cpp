#include <drivers/crash_record.hpp>

namespace inkwell::drivers {
namespace {

constexpr std::uint32_t mark = 0x696E6B77;

struct Kept {
  std::uint32_t mark;
  CrashRecord record;
  std::uint32_t check;
};

[[gnu::noinit]] Kept kept;

std::uint32_t check_of(const CrashRecord& record) {
  return mark ^ record.exception ^ record.program_counter ^ record.link_register ^ record.configurable_fault_status ^
         record.hard_fault_status ^ record.fault_address;
}

}  // namespace

void leave_crash_record(const CrashRecord& record) { kept = {mark, record, check_of(record)}; }

std::optional<CrashRecord> take_crash_record() {
  const bool valid = kept.mark == mark && kept.check == check_of(kept.record);
  kept.mark = 0;
  if (!valid) return std::nullopt;
  return kept.record;
}

}  // namespace inkwell::drivers
