// Requests of DFU 1.1 and of ST's DFU extension (AN3156).
#include <algorithm>
#include <cstring>
#include <utility>

#include "boards/virtual/usb/boot_loader.hpp"

namespace inkwell::virtual_board {
namespace {

namespace dfu_request {
constexpr std::uint8_t download = 1, upload = 2, get_status = 3, clear_status = 4, get_state = 5, abort = 6;
}
namespace dfu_command {
constexpr std::uint8_t get_commands = 0x00, set_address = 0x21, erase = 0x41, read_unprotect = 0x92;
}
constexpr unsigned first_data_block = 2;

constexpr std::uint32_t flash_begin = 0x0800'0000, flash_end = 0x0810'0000, ram_begin = 0x2000'3000,
                        ram_end = 0x2002'0000, system_begin = 0x1FFF'0000, system_end = 0x1FFF'7A30,
                        options_begin = 0x1FFF'C000, options_bytes = 16;

/// Flash registers (RM0090, "Embedded Flash memory interface").
constexpr std::uint32_t flash_keyr = 0x4002'3C04, flash_optkeyr = 0x4002'3C08, flash_sr = 0x4002'3C0C,
                        flash_cr = 0x4002'3C10, flash_optcr = 0x4002'3C14, aircr = 0xE000'ED0C;
constexpr std::uint32_t cr_pg = 1, cr_ser = 2, cr_mer = 4, cr_word_parallelism = 2 << 8, cr_strt = 1 << 16,
                        cr_lock = 1u << 31, sr_errors = 0xF2, optcr_lock = 1, optcr_start = 2;
constexpr std::uint32_t system_reset_request = 0x05FA'0004;
/// OPTCR bits that contain option bytes: user options, RDP and nWRP.
constexpr std::uint32_t user_options = 0xEC, write_protection = 0xFFF;

constexpr bool lies_in(std::uint32_t address, std::uint32_t begin, std::uint32_t end) {
  return address >= begin && address < end;
}
constexpr bool is_whole_in(std::uint32_t address, std::size_t bytes, std::uint32_t begin, std::uint32_t end) {
  return lies_in(address, begin, end) && bytes <= end - address;
}

constexpr unsigned sector_of(std::uint32_t address) {
  const std::uint32_t offset = address - flash_begin;
  return offset < 0x1'0000 ? offset / 0x4000 : offset < 0x2'0000 ? 4 : 4 + offset / 0x2'0000;
}

std::uint32_t word_at(std::span<const std::byte> bytes) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data(), sizeof word);
  return word;
}

std::uint32_t register_word(DebugPort& memory, std::uint32_t address) {
  std::array<std::uint8_t, 4> bytes{};
  memory.read(address, bytes);
  return word_at(std::as_bytes(std::span(bytes)));
}

}  // namespace

void BootLoaderDfu::start() {
  *this = {};
  pointer_ = flash_begin;
}

bool BootLoaderDfu::fail(Status status) {
  state_ = State::error;
  status_ = status;
  waiting_.reset();
  return false;
}

bool BootLoaderDfu::take(const SetupPacket& request, std::span<const std::byte> data) {
  switch (request.request) {
    case dfu_request::download: return download(request.value, data);
    case dfu_request::clear_status:
      if (state_ == State::error) state_ = State::idle;
      status_ = Status::ok;
      return true;
    case dfu_request::abort:
      if (state_ == State::error) return false;
      state_ = State::idle;
      waiting_.reset();
      return true;
    default: return false;
  }
}

bool BootLoaderDfu::download(std::uint16_t block, std::span<const std::byte> data) {
  if (state_ != State::idle && state_ != State::download_idle) return fail(Status::stalled);
  if (data.empty()) {
    waiting_ = Operation{.kind = Operation::Kind::leave};
    state_ = State::manifest_sync;
    return true;
  }
  if (block == 0) {
    waiting_ = command_of(data);
    if (!waiting_) return fail(Status::stalled);
  } else if (block < first_data_block || data.size() > transfer_bytes) {
    return fail(Status::stalled);
  } else {
    const std::uint32_t address = pointer_ + (block - first_data_block) * transfer_bytes;
    const auto kind = lies_in(address, options_begin, options_begin + options_bytes) ? Operation::Kind::write_options
                                                                                     : Operation::Kind::write;
    waiting_ = Operation{.kind = kind, .address = address, .data = {data.begin(), data.end()}};
  }
  state_ = State::download_sync;
  return true;
}

std::optional<BootLoaderDfu::Operation> BootLoaderDfu::command_of(std::span<const std::byte> data) {
  const auto command = std::to_integer<std::uint8_t>(data[0]);
  if (command == dfu_command::erase && data.size() == 1) return Operation{.kind = Operation::Kind::erase_all};
  if (data.size() != 5 || (command != dfu_command::set_address && command != dfu_command::erase)) return {};
  return Operation{.kind = command == dfu_command::erase ? Operation::Kind::erase : Operation::Kind::set_address,
                   .address = word_at(data.subspan(1))};
}

std::optional<std::vector<std::byte>> BootLoaderDfu::answer(const SetupPacket& request) {
  if (request.request == dfu_request::get_state) return std::vector{static_cast<std::byte>(state_)};
  if (request.request == dfu_request::get_status) return status();
  if (request.request != dfu_request::upload) return {};
  if (read_) return std::exchange(read_, std::nullopt);
  if (state_ == State::error) return {};
  if (state_ != State::idle && state_ != State::upload_idle) {
    fail(Status::stalled);
    return {};
  }
  state_ = State::upload_idle;
  if (request.value == 0)
    return std::vector{std::byte{dfu_command::get_commands}, std::byte{dfu_command::set_address},
                       std::byte{dfu_command::erase}, std::byte{dfu_command::read_unprotect}};
  // Block addresses are multiples of the request length, not of the transfer size in the descriptor (AN3156).
  const std::uint32_t length = std::min(request.length, transfer_bytes);
  asked_ = Operation{.kind = Operation::Kind::read,
                     .address = pointer_ + (request.value - first_data_block) * length,
                     .length = length};
  return std::vector<std::byte>{};
}

/// Answers the status request and starts the waiting operation. The next status request is answered after the
/// operation.
std::vector<std::byte> BootLoaderDfu::status() {
  State reported = state_;
  unsigned poll_ms = 0;
  if (waiting_) {
    const auto& operation = *waiting_;
    const bool is_leave = operation.kind == Operation::Kind::leave;
    const bool is_there =
        is_leave || operation.kind == Operation::Kind::erase_all ||
        is_whole_in(operation.address, operation.data.size(), flash_begin, flash_end) ||
        is_whole_in(operation.address, operation.data.size(), options_begin, options_begin + options_bytes) ||
        (operation.kind != Operation::Kind::erase &&
         is_whole_in(operation.address, operation.data.size(), ram_begin, ram_end)) ||
        (operation.kind == Operation::Kind::set_address && lies_in(operation.address, system_begin, system_end));
    if (!is_there) {
      fail(Status::target);
      reported = state_;
    } else {
      reported = is_leave ? State::manifest : State::download_busy;
      poll_ms = poll_time_ms(operation);
      state_ = is_leave ? State::manifest : State::download_idle;
      asked_ = std::exchange(waiting_, std::nullopt);
    }
  }
  return {static_cast<std::byte>(status_), std::byte(poll_ms & 0xFF),        std::byte(poll_ms >> 8 & 0xFF),
          std::byte(poll_ms >> 16),        static_cast<std::byte>(reported), std::byte{0}};
}

/// Typical programming times from the data sheet.
unsigned BootLoaderDfu::poll_time_ms(const Operation& operation) {
  switch (operation.kind) {
    case Operation::Kind::erase: {
      const unsigned sector = sector_of(operation.address);
      return sector < 4 ? 250 : sector == 4 ? 550 : 1000;
    }
    case Operation::Kind::erase_all: return 8000;
    case Operation::Kind::write: return 1 + static_cast<unsigned>(operation.data.size()) * 16 / 4 / 1000;
    case Operation::Kind::write_options: return 250;
    default: return 0;
  }
}

void BootLoaderDfu::store(std::uint32_t address, std::uint32_t word) {
  steps_.push_back({LoaderOrder::Kind::store, address, word});
}

void BootLoaderDfu::unlock() {
  store(flash_keyr, 0x4567'0123);
  store(flash_keyr, 0xCDEF'89AB);
  store(flash_sr, sr_errors);
}

LoaderOrder BootLoaderDfu::next_order(DebugPort& memory) {
  if (asked_) begin(memory);
  if (is_working_ && steps_.empty()) finish(memory);
  if (steps_.empty()) return {};
  current_ = std::move(steps_.front());
  steps_.pop_front();
  if (current_.kind == LoaderOrder::Kind::go || current_.address == aircr) has_left_ = true;
  return {current_.kind, current_.address, current_.word, current_.data};
}

void BootLoaderDfu::begin(DebugPort& memory) {
  Operation operation = *std::exchange(asked_, std::nullopt);
  switch (operation.kind) {
    case Operation::Kind::set_address: pointer_ = operation.address; return;
    case Operation::Kind::leave: steps_.push_back({LoaderOrder::Kind::go, 0, 0}); return;
    case Operation::Kind::read: read_ = read(memory, operation.address, operation.length); return;
    case Operation::Kind::erase:
    case Operation::Kind::erase_all: {
      const std::uint32_t what =
          cr_word_parallelism |
          (operation.kind == Operation::Kind::erase ? cr_ser | sector_of(operation.address) << 3 : cr_mer);
      unlock();
      store(flash_cr, what);
      store(flash_cr, what | cr_strt);
      break;
    }
    case Operation::Kind::write: {
      while (operation.data.size() % 4 != 0) operation.data.push_back(std::byte{0xFF});
      unlock();
      store(flash_cr, cr_word_parallelism | cr_pg);
      steps_.push_back({LoaderOrder::Kind::program, operation.address, 0, std::move(operation.data)});
      break;
    }
    case Operation::Kind::write_options: {
      std::array<std::byte, options_bytes> bytes = {};
      std::ranges::copy(std::span(operation.data).first(std::min<std::size_t>(operation.data.size(), bytes.size())),
                        bytes.begin());
      const std::uint32_t options =
          (word_at(bytes) & (0xFF00 | user_options)) | (word_at(std::span(bytes).subspan(8)) & write_protection) << 16;
      store(flash_optkeyr, 0x0819'2A3B);
      store(flash_optkeyr, 0x4C5D'6E7F);
      store(flash_optcr, options);
      store(flash_optcr, options | optcr_start);
      store(flash_optcr, options | optcr_lock);
      store(aircr, system_reset_request);  // only a reset loads the option bytes
      break;
    }
  }
  is_working_ = true;
}

void BootLoaderDfu::finish(DebugPort& memory) {
  is_working_ = false;
  if ((register_word(memory, flash_sr) & sr_errors) != 0) fail(Status::programming);
  store(flash_cr, cr_lock);
}

std::optional<std::vector<std::byte>> BootLoaderDfu::read(DebugPort& memory, std::uint32_t address,
                                                          std::uint32_t length) {
  std::vector<std::byte> bytes(length);
  if (lies_in(address, options_begin, options_begin + options_bytes)) {
    const std::uint32_t options = register_word(memory, flash_optcr);
    constexpr std::uint32_t unused_bits = 0x13;
    std::array<std::uint32_t, options_bytes / 4> words{};
    words[0] = (options & 0xFFFF) | unused_bits;
    words[2] = options >> 16 | 0xF000;
    const auto there = std::as_bytes(std::span(words)).subspan(address - options_begin);
    bytes.assign(there.begin(),
                 there.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(length, there.size())));
    return bytes;
  }
  std::vector<std::uint8_t> read(length);
  if (!memory.read(address, read)) {
    fail(Status::address);
    return {};
  }
  std::memcpy(bytes.data(), read.data(), length);
  return bytes;
}

}  // namespace inkwell::virtual_board
