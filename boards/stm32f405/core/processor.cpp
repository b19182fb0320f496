#include "boards/stm32f405/core/processor.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "boards/stm32f405/core/chip_error.hpp"
#include "boards/stm32f405/core/xpsr.hpp"

namespace inkwell::virtual_board {
namespace {

void check(uc_err error, const char* what) {
  if (error != UC_ERR_OK)
    throw ChipError(std::string("The processor emulation (Unicorn) cannot ") + what + ": " + uc_strerror(error) + ".");
}

template <class Function>
uc_err add_hook(uc_engine* engine, int type, Function* function, void* self) {
  uc_hook hook;
  return uc_hook_add(engine, &hook, type, reinterpret_cast<void*>(function), self, 1, 0);
}

// Unicorn passes these numbers to the interrupt hook.
enum : std::uint32_t {
  undefined = 1,
  software_interrupt = 2,
  prefetch_abort = 3,
  data_abort = 4,
  breakpoint = 7,
  exception_exit = 8,
  no_coprocessor = 17,
  invalid_state = 18,
};

}  // namespace

Processor::Processor(Machine& machine, const BusWindows& windows, FlashPort& flash)
    : machine_(machine),
      windows_(windows),
      flash_port_(flash),
      timing_(machine.options.pricing, {flash_base, flash_bytes, sram_base, sram_bytes},
              [&memory = machine.memory](std::uint32_t address) { return memory.word(address); }),
      register_bus_(timing_.costs()) {
  machine.clock_users.push_back(this);
  machine.on_ram_write = [this](std::uint32_t address, std::uint32_t bytes) {
    if (!plain_stores_.holds_code(address)) return;
    forget_code_later(address, bytes);
    end_slice();
  };
  check(uc_open(UC_ARCH_ARM, UC_MODE_THUMB, &engine_), "start");
  // The Cortex-M4 model already selects the M profile; UC_MODE_MCLASS would select another CPU model.
  check(uc_ctl_set_cpu_model(engine_, UC_CPU_ARM_CORTEX_M4), "emulate a Cortex-M4");
  map_memories();
  check(add_hook(engine_, UC_HOOK_BLOCK, block_hook, this), "add a block hook");
  if (machine.options.mode == Mode::exact) check(add_hook(engine_, UC_HOOK_CODE, code_hook, this), "add a code hook");
  check(add_hook(engine_, UC_HOOK_INTR, interrupt_hook, this), "report exceptions");
  check(add_hook(engine_, UC_HOOK_INSN_INVALID, invalid_hook, this), "report invalid instructions");
  check(add_hook(engine_, UC_HOOK_MEM_WRITE_PROT, flash_store_hook, this), "report stores to the flash");
}

Processor::~Processor() {
  if (engine_ != nullptr) uc_close(engine_);
}

void Processor::map_memories() {
  auto& memory = machine_.memory;
  const auto map = [&](std::uint32_t base, std::uint32_t bytes, std::uint32_t rights, std::uint8_t* host_memory) {
    check(uc_mem_map_ptr(engine_, base, bytes, rights, host_memory), "map a memory");
  };
  // At each access except plain loads, Unicorn searches its memory regions in mapping order. The most frequently used
  // regions are therefore mapped first.
  map(sram_base, sram_bytes, UC_PROT_ALL, memory.sram());
  map(ccm_base, ccm_bytes, UC_PROT_ALL, memory.ccm());
  for (const auto& window : windows_.list)
    check(uc_mmio_map(engine_, window.base, window.bytes, window.read, windows_.bus, window.write, windows_.bus),
          "map the registers");
  map(flash_base, flash_bytes, UC_PROT_READ | UC_PROT_EXEC, memory.flash());
  map(system_base, system_bytes, UC_PROT_ALL, memory.system());
  map_memory_at_zero();
  map_holes();
}

void Processor::map_memory_at_zero() {
  const auto bytes = machine_.memory.bytes_at_zero();
  const bool is_flash = machine_.memory.at_zero() == MemoryAtZero::flash;
  check(uc_mem_map_ptr(engine_, 0, bytes.size(), is_flash ? UC_PROT_READ | UC_PROT_EXEC : UC_PROT_ALL, bytes.data()),
        "map a memory at address 0");
  if (bytes.size() < flash_bytes) map_hole(static_cast<std::uint32_t>(bytes.size()), flash_bytes);
}

void Processor::take_new_memory_at_zero() {
  const auto memory = *std::exchange(new_memory_at_zero_, std::nullopt);
  if (memory == machine_.memory.at_zero()) return;
  const std::size_t bytes = machine_.memory.bytes_at_zero().size();
  uc_ctl_remove_cache(engine_, std::uint64_t{0}, std::uint64_t{bytes});
  check(uc_mem_unmap(engine_, 0, bytes), "unmap the memory at address 0");
  if (bytes < flash_bytes) check(uc_mem_unmap(engine_, bytes, flash_bytes - bytes), "unmap the memory at address 0");
  machine_.memory.map_at_zero(memory);
  map_memory_at_zero();
  plain_stores_.forget_code_at_zero();
  timing_.map_at_zero(memory == MemoryAtZero::flash   ? CodeMap::AtZero::flash
                      : memory == MemoryAtZero::sram1 ? CodeMap::AtZero::sram
                                                      : CodeMap::AtZero::other);
  rights_changed_ = true;
}

// At an access to an unmapped address, the engine does not report the instruction. All remaining address ranges are
// therefore mapped, so that the engine calls refuses().
void Processor::map_holes() {
  uc_mem_region* regions = nullptr;
  std::uint32_t count = 0;
  check(uc_mem_regions(engine_, &regions, &count), "list the memories");
  std::vector<std::pair<std::uint64_t, std::uint64_t>> taken;  // first byte, end
  for (std::uint32_t i = 0; i < count; ++i) taken.emplace_back(regions[i].begin, regions[i].end + 1);
  uc_free(regions);
  constexpr std::uint64_t end_of_addresses = 0x1'0000'0000;
  taken.emplace_back(end_of_addresses, end_of_addresses);
  std::sort(taken.begin(), taken.end());
  std::uint64_t at = 0;
  for (const auto& [first, end] : taken) {
    if (first > at) map_hole(at, first);
    at = end;
  }
}

void Processor::map_hole(std::uint64_t first, std::uint64_t end) {
  check(uc_mmio_map(
            engine_, first, end - first, [](uc_engine*, std::uint64_t, unsigned, void*) { return std::uint64_t{0}; },
            nullptr, [](uc_engine*, std::uint64_t, unsigned, std::uint64_t, void*) {}, nullptr),
        "map unused addresses");
}

void Processor::reset(std::uint32_t vector_table) {
  if (new_memory_at_zero_) take_new_memory_at_zero();
  for (int id = UC_ARM_REG_R0; id <= UC_ARM_REG_R12; ++id) write(id, 0);
  current_exception_ = exception_none;
  write(UC_ARM_REG_CONTROL, 0);
  write(UC_ARM_REG_IPSR, 0);
  write(UC_ARM_REG_PRIMASK, 0);
  write(UC_ARM_REG_FAULTMASK, 0);
  write(UC_ARM_REG_BASEPRI, 0);
  write(UC_ARM_REG_FPSCR, 0);
  write(UC_ARM_REG_XPSR_NZCVQG, xpsr.thumb.mask());
  write(UC_ARM_REG_APSR_NZCV, 0);
  write(UC_ARM_REG_PSP, 0);
  const std::uint32_t stack = machine_.memory.word(vector_table) & ~3u;
  constexpr std::uint32_t erased = 0xFFFF'FFFC;
  if (stack != erased && machine_.memory.ram_at(stack - 4, 4) == nullptr)
    machine_.violations.violate(Rule::stack_outside_memory);
  write(UC_ARM_REG_MSP, stack);
  write(UC_ARM_REG_LR, 0xFFFFFFFF);
  program_counter_ = machine_.memory.word(vector_table + 4);
  timing_.redirect();
  timing_.stack_lazily(false);
  watch_masks_ = event_register_ = false;
  set_float_unit(false);
  set_unstacked_float({});
  core_coupled_on_ = true;
  while (!running_.empty()) end_counting();
  // The firmware may have been replaced before this reset.
  forget_code(flash_base, flash_bytes);
  forget_code(sram_base, sram_bytes);
}

void Processor::forget_code(std::uint32_t address, std::uint32_t bytes) {
  uc_ctl_remove_cache(engine_, std::uint64_t{address}, std::uint64_t{address} + bytes);
  if (const auto other = machine_.memory.other_address(address)) {
    const std::uint64_t first = *other;
    const std::uint64_t end = first < flash_base ? machine_.memory.bytes_at_zero().size() : first + bytes;
    uc_ctl_remove_cache(engine_, first, std::min(first + bytes, end));
  }
  // The engine fetches from the range without the checks of EngineCalls, and caches the address with all rights.
  forget_pages();
  // All block prices are discarded, because a block may start before the changed range and overlap the range.
  if (machine_.memory.is_in_flash(address)) timing_.forget();
}

std::uint64_t Processor::cycles_until(Ticks when) const {
  const Ticks time = now();
  if (when <= time) return 1;
  const auto& clock = machine_.clocks.hclk;
  return std::max<std::uint64_t>(
      1, (std::min(when - time, ticks_per_s) * clock.denominator + clock.numerator - 1) / clock.numerator);
}

Masks Processor::masks() const {
  return {(read(UC_ARM_REG_PRIMASK) & 1) != 0, (read(UC_ARM_REG_FAULTMASK) & 1) != 0, read(UC_ARM_REG_BASEPRI)};
}

Outcome Processor::run(std::uint64_t cycles) {
  stop_cycle_ = cycles_ + cycles;
  if (guard_bytes_ != 0) guard_float_instructions();
  if (new_memory_at_zero_) take_new_memory_at_zero();
  for (const auto& [address, bytes] : std::exchange(to_forget_, {})) forget_code(address, bytes);
  take_new_rights();
  stopped_ = false;
  stopped_before_.reset();
  block_ = nullptr;
  instruction_end_ = cycles_;
  outcome_ = Outcome::slice_over;
  if ((program_counter_ & 1) == 0 && program_counter_ != 0) program_counter_ |= 1;
  // With too few wait states, the model faults immediately, although real hardware may execute some instructions.
  if (machine_.flash_is_misread && program_counter_ - flash_base < flash_bytes) return Outcome::undefined_instruction;
  uc_err error;
  {
    const Use use(*this);
    error = uc_emu_start(engine_, program_counter_ | 1, 0, 0, 0);
  }
  if (new_memory_at_zero_) take_new_memory_at_zero();
  // If instruction hooks exist, Unicorn 2.0.1 does not update the program counter when it stops before a block.
  program_counter_ = stopped_before_.value_or(read(UC_ARM_REG_PC) & ~1u);
  if (!stopped_ && block_ != nullptr) cycles_ = instruction_end_;
  if (!flash_stores_.empty()) finish_flash_stores();
  if (!new_divides_.empty()) hook_new_divides();
  if (outcome_ != Outcome::slice_over) return outcome_;
  if (error == UC_ERR_INSN_INVALID) return Outcome::undefined_instruction;
  check(error, "run");
  return stopped_ ? Outcome::slice_over : Outcome::wait_for_interrupt;
}

void Processor::finish_flash_stores() {
  for (const auto& store : flash_stores_) {
    std::memcpy(machine_.memory.at(store.address, store.size), &store.content, store.size);
    forget_code(store.address, store.size);
  }
  flash_stores_.clear();
}

[[gnu::noinline]] const BlockPrice& Processor::price_block(std::uint32_t address, std::uint32_t bytes) {
  const bool is_in_sram1 = machine_.memory.at_zero() == MemoryAtZero::sram1 && address < sram1_bytes;
  if (is_in_sram1 || address - sram_base < sram_bytes) plain_stores_.code_runs_at(address, bytes, *this);
  return timing_.block(address, {machine_.memory.at(address, bytes), bytes});
}

void Processor::after_clock_change() {
  const auto& clocks = machine_.clocks.frequencies;
  register_bus_.set_clocks(clocks.hclk_Hz, clocks.pclk1_Hz, clocks.pclk2_Hz);
  end_slice();
}

void Processor::wait_for_register(std::uint32_t address, bool write) {
  wait(register_bus_.access(address, write, cycles_));
}

unsigned Processor::divide_wait(const BlockPrice::Divide& divide) const {
  const auto& costs = timing_.costs();
  const auto value = register_reader();
  return divide_cycles(value(divide.dividend), value(divide.divisor), divide.is_signed, costs) -
         costs[Cost::divide_shortest];
}

bool Processor::masks_open() {
  if (machine_.debugging.steps || machine_.nvic.next(masks()) == exception_none) return false;
  masks_opened_ = true;
  return true;
}

void Processor::block_hook(uc_engine*, std::uint64_t address, std::uint32_t size, void* pointer) {
  auto& self = *static_cast<Processor*>(pointer);
  const auto start = static_cast<std::uint32_t>(address);
  const bool exact = self.machine_.options.mode == Mode::exact;
  if (exact) {
    self.cycles_ = self.instruction_end_;  // the code hook decides whether to stop
  } else {
    if (self.cycles_ >= self.stop_cycle_ || (self.watch_masks_ && self.masks_open())) return self.stop_before(start);
  }
  if (self.flash_is_busy_ && self.machine_.memory.is_in_flash(start)) return self.stop_before(start);
  if (self.refuses_float_ && self.has_unguarded_float(start, size)) {
    self.guard_address_ = start;
    self.guard_bytes_ = size;
    return self.stop_before(start);
  }
  const BlockPrice* known = self.timing_.known_block(start, size);
  const BlockPrice& block = known != nullptr ? *known : self.price_block(start, size);
  std::uint64_t cycles = self.cycles_;
  cycles += self.timing_.enter(block, cycles);
  self.cycles_ = cycles;
  if (exact) {
    self.block_ = &block;
    self.block_start_ = cycles;
    self.next_request_ = self.next_divide_ = self.next_read_ = 0;
    self.block_is_plain_ = self.is_plain(block);
    return;
  }
  if (block.has_divides && self.machine_.traps_zero_division && self.has_new_divides(block))
    return self.stop_before(start);
  self.last_code_address_ = start;
  self.instructions_ += block.instructions;
  cycles += self.timing_.wait_for_flash(block, cycles, self.register_reader()) + block.cycles;
  // If a block computes the operands of its divide instruction, the mean divide time is used.
  if (block.has_divides)
    for (const auto& divide : block.divides)
      cycles += divide.known_at_entry ? self.divide_wait(divide) : divide_mean(self.timing_.costs());
  self.cycles_ = cycles;
}

// Plain blocks need no check at each instruction. Because most blocks are plain, the code hook is fast.
bool Processor::is_plain(const BlockPrice& block) const {
  const bool needs_flash = !timing_.flash().is_free() && !(block.requests.empty() && block.reads.empty());
  return !needs_flash && block.divides.empty() && !machine_.debugging.attached && !machine_.options.on_instruction;
}

void Processor::code_hook(uc_engine*, std::uint64_t address, std::uint32_t bytes, void* pointer) {
  auto& self = *static_cast<Processor*>(pointer);
  const auto at = static_cast<std::uint32_t>(address);
  const auto& starts = self.block_->starts;
  const std::size_t half_word = std::min<std::size_t>((at - self.block_->address) / 2, starts.size() - 1);
  const std::size_t next = half_word + bytes / 2;
  self.cycles_ = self.block_start_ + starts[half_word];
  const bool may_stop = self.cycles_ >= self.stop_cycle_ || self.watch_masks_ || !self.block_is_plain_;
  if (may_stop && !self.may_run(at)) return;
  self.instruction_end_ = self.block_start_ + (next < starts.size() ? starts[next] : self.block_->cycles);
  self.last_code_address_ = at;
  self.recent_addresses_[self.instructions_ % self.recent_addresses_.size()] = at;
  ++self.instructions_;
  if (!self.block_is_plain_) self.wait_in_block(at, starts[half_word]);
}

// In exact mode, returns false if the processor must stop before the instruction. The reason for this stop may be time,
// an interrupt, a debugger or a division by zero.
[[gnu::noinline]] bool Processor::may_run(std::uint32_t address) {
  const bool due = cycles_ >= stop_cycle_ || (watch_masks_ && masks_open());
  if (due && !in_if_then_block(address)) {
    stop();
    return false;
  }
  if (machine_.debugging.attached && stop_for_debugger(address)) return false;
  if (machine_.traps_zero_division && !block_->divides.empty() && divides_by_zero(address)) {
    outcome_ = Outcome::division_by_zero;
    stop();
    return false;
  }
  if (machine_.options.on_instruction) machine_.options.on_instruction(address, cycles_);
  return true;
}

// In exact mode, adds the wait cycles of the instruction at `address`. The instruction starts `after_cycles` cycles
// after the start of its block.
[[gnu::noinline]] void Processor::wait_in_block(std::uint32_t address, std::uint16_t after_cycles) {
  const auto& requests = block_->requests;
  const auto& divides = block_->divides;
  const auto& reads = block_->reads;
  for (auto& i = next_request_; i < requests.size() && requests[i].after_cycles <= after_cycles; ++i)
    wait(timing_.wait_for(requests[i], cycles_));
  for (auto& i = next_divide_; i < divides.size() && divides[i].address <= address; ++i)
    if (divides[i].address == address) wait(divide_wait(divides[i]));
  for (auto& i = next_read_; i < reads.size() && reads[i].instruction <= address; ++i)
    if (reads[i].instruction == address) wait(timing_.wait_for(reads[i], cycles_, register_reader()));
}

bool Processor::if_then_block_covers(std::uint32_t if_then, std::uint32_t address) const {
  // In an IT instruction (ARMv7-M, A7.7.38), the lowest set mask bit marks the end of the if-then block.
  const std::uint16_t instruction = machine_.memory.half_word(if_then);
  const unsigned mask = instruction & 0xFu;
  if ((instruction & 0xFF00u) != 0xBF00u || mask == 0 || address <= if_then) return false;
  std::uint32_t end = if_then + 2;
  for (int left = 4 - std::countr_zero(mask); left > 0; --left) end += is_wide(machine_.memory.half_word(end)) ? 4 : 2;
  return address < end;
}

bool Processor::in_if_then_block(std::uint32_t address) const {
  if (in_resumed_if_then_block(address)) return true;
  return std::any_of(recent_addresses_.begin(), recent_addresses_.end(),
                     [&](std::uint32_t recent) { return if_then_block_covers(recent, address); });
}

void Processor::interrupt_hook(uc_engine* engine, std::uint32_t number, void* pointer) {
  auto& self = *static_cast<Processor*>(pointer);
  switch (number) {
    case software_interrupt: self.outcome_ = Outcome::supervisor_call; break;
    case breakpoint: self.outcome_ = Outcome::breakpoint; break;
    case exception_exit:
      self.outcome_ = Outcome::exception_return;
      self.fault_address_ = self.read(UC_ARM_REG_PC) | 1;
      break;
    case no_coprocessor: self.outcome_ = Outcome::no_coprocessor; break;
    case invalid_state: self.outcome_ = Outcome::invalid_state; break;
    case prefetch_abort:
    case data_abort: self.outcome_ = self.refusal_.value_or(Outcome::undefined_instruction); break;
    case undefined:
    default: self.outcome_ = Outcome::undefined_instruction; break;
  }
  uc_emu_stop(engine);
}

bool Processor::invalid_hook(uc_engine* engine, void* pointer) {
  auto& self = *static_cast<Processor*>(pointer);
  // Unicorn also calls this hook for WFE and YIELD. The program counter then points after the WFE or YIELD. For an
  // undefined instruction, the program counter points to the instruction.
  const std::uint32_t after = self.read(UC_ARM_REG_PC) & ~1u;
  constexpr std::uint16_t yield = 0xBF10, wait_for_event = 0xBF20;
  constexpr std::uint16_t wide_hint = 0xF3AF, wide_yield = 0x8001, wide_wait_for_event = 0x8002;
  const std::uint16_t last = self.machine_.memory.half_word(after - 2);
  const bool wide = self.machine_.memory.half_word(after - 4) == wide_hint;
  if (self.last_code_address_ != after) {
    if (last == wait_for_event || (wide && last == wide_wait_for_event))
      self.outcome_ = Outcome::wait_for_event;
    else if (last == yield || (wide && last == wide_yield))
      self.stopped_ = true;
    else
      self.outcome_ = Outcome::undefined_instruction;
    if (self.stopped_ || self.outcome_ == Outcome::wait_for_event) {
      uc_emu_stop(engine);
      return true;
    }
  }
  self.outcome_ = Outcome::undefined_instruction;
  return false;
}

// Starts flash programming at a store to the flash (RM0090, "Flash programming").
bool Processor::flash_store_hook(uc_engine*, uc_mem_type, std::uint64_t address, int size, std::int64_t value,
                                 void* pointer) {
  auto& self = *static_cast<Processor*>(pointer);
  const auto target = static_cast<std::uint32_t>(address);
  if (self.refusal_of(target, Access::store, self.role())) return true;  // the fault follows
  const auto bytes = static_cast<unsigned>(size);
  if (const auto content = self.flash_port_.program(target, static_cast<std::uint32_t>(value), bytes)) {
    self.flash_stores_.push_back({target, *content, bytes});
    self.end_slice();
  }
  return true;
}

}  // namespace inkwell::virtual_board
