#include "boards/virtual/usb/host_controller.hpp"

#include <algorithm>

#include "boards/stm32f405/otg_fs/bit_stuffing.hpp"

namespace inkwell::virtual_board {

namespace {
constexpr double nominal_frame_s = 0.001;
constexpr Ticks byte_ticks = 8 * bit_ticks;
// Overhead of a transaction in bytes (USB 2.0, tables 5-8 to 5-10): token, handshake, synchronization and turn-around.
// With an overhead of 13 bytes, 19 bulk packets of 64 bytes fit in a frame. Stuffed bits are added separately.
constexpr Ticks transaction_bytes = 13;
constexpr Ticks refused_in_bytes = 8;
constexpr Ticks start_of_frame_bytes = 6;
// The poll interval of an endpoint increases while the endpoint is not ready.
constexpr Ticks retry_first = refused_in_bytes * byte_ticks;
constexpr Ticks retry_maximum = ticks(nominal_frame_s / 4);
constexpr unsigned frames_until_suspend = 3;
constexpr unsigned errors_allowed = 3;  // USB 2.0, section 10.2.6

constexpr unsigned pipe_index(unsigned endpoint, bool in) { return endpoint == 0 ? 0 : endpoint + (in ? 16 : 0); }
constexpr unsigned endpoint_of(unsigned pipe) { return pipe & 15; }
}  // namespace

HostController::HostController(Scheduler& scheduler, BusDevice& device, Client& client, double clock_ppm)
    : scheduler_(scheduler),
      device_(device),
      client_(client),
      frame_ticks_(ticks(nominal_frame_s / (1.0 + clock_ppm * 1e-6))),
      frame_begin_(scheduler.now()) {
  address_device(0, 8);
  event_ = scheduler_.at(frame_begin_ + frame_ticks_, [this] { step(); });
}

HostController::~HostController() { scheduler_.cancel(event_); }

void HostController::run_frames(bool run) {
  if (frames_run_ && !run) frames_idle_ = 0;
  frames_run_ = run;
}

void HostController::address_device(unsigned address, std::uint16_t control_packet_maximum) {
  address_ = address;
  pipes_[0].open = true;
  pipes_[0].type = TransferType::control;
  pipes_[0].packet_maximum = std::max<std::uint16_t>(8, control_packet_maximum);
}

void HostController::configure(const ConfigurationDescription* configuration) {
  for (unsigned i = 1; i < pipe_count; ++i) close(pipes_[i]);
  busy_pipes_ &= 1;
  if (configuration == nullptr) return;
  for (const EndpointDescription& endpoint : configuration->endpoints)
    if (endpoint.alternate == 0) open(endpoint);
}

void HostController::select_alternate(const ConfigurationDescription& configuration, std::uint8_t interface,
                                      std::uint8_t alternate) {
  for (const EndpointDescription& endpoint : configuration.endpoints) {
    if (endpoint.interface != interface) continue;
    const unsigned index = pipe_index(endpoint.address & 15u, (endpoint.address & 0x80) != 0);
    close(pipes_[index]);
    busy_pipes_ &= ~(1u << index);
  }
  for (const EndpointDescription& endpoint : configuration.endpoints)
    if (endpoint.interface == interface && endpoint.alternate == alternate) open(endpoint);
}

// Completes the transfers of a removed pipe with the status that host drivers expect.
void HostController::close(Pipe& pipe) {
  std::deque<Urb> urbs = std::move(pipe.urbs);
  pipe = Pipe{};
  if (transaction_ && &pipes_[transaction_->pipe] == &pipe) transaction_->abandoned = true;
  for (Urb& urb : urbs) client_.completed(std::move(urb), transfer_status::invalid);
}

void HostController::open(const EndpointDescription& endpoint) {
  const unsigned number = endpoint.address & 15u;
  if (number == 0 || endpoint.packet_maximum == 0 || endpoint.type == TransferType::isochronous) return;
  Pipe& pipe = pipes_[pipe_index(number, (endpoint.address & 0x80) != 0)];
  pipe.open = true;
  pipe.type = endpoint.type;
  pipe.packet_maximum = std::min<std::uint16_t>(endpoint.packet_maximum, 64);
  pipe.interval_frames = endpoint.interval_frames;
}

void HostController::reset_toggle(std::uint8_t endpoint_address) {
  pipes_[pipe_index(endpoint_address & 15u, (endpoint_address & 0x80) != 0)].data1 = false;
}

void HostController::submit(Urb&& urb) {
  const unsigned index = pipe_index(urb.endpoint, urb.in);
  Pipe& pipe = pipes_[index];
  if (!pipe.open || !urb.packets.empty()) {
    client_.completed(std::move(urb), transfer_status::invalid);
    return;
  }
  // The host controller fixes the schedule of a frame at the start of the frame. An interrupt OUT transfer to an idle
  // endpoint starts at the earliest in the next frame.
  if (pipe.type == TransferType::interrupt && !urb.in && pipe.urbs.empty())
    pipe.due_frame = std::max(pipe.due_frame, frame_ + 1);
  pipe.urbs.push_back(std::move(urb));
  busy_pipes_ |= 1u << index;
}

std::optional<Urb> HostController::unlink(std::uint32_t sequence) {
  for (unsigned i = 0; i < pipe_count; ++i) {
    std::deque<Urb>& urbs = pipes_[i].urbs;
    const auto found = std::find_if(urbs.begin(), urbs.end(),
                                    [&](const Urb& urb) { return urb.sequence == sequence && !urb.internal; });
    if (found == urbs.end()) continue;
    if (transaction_ && transaction_->pipe == i && found == urbs.begin()) transaction_->abandoned = true;
    std::optional<Urb> taken_back = std::move(*found);
    urbs.erase(found);
    if (urbs.empty()) busy_pipes_ &= ~(1u << i);
    return taken_back;
  }
  return std::nullopt;
}

void HostController::cancel_all() {
  for (Pipe& pipe : pipes_) {
    pipe.urbs.clear();
    pipe.errors = 0;
    pipe.retry_at = pipe.retry_after = 0;
  }
  busy_pipes_ = 0;
  if (transaction_) transaction_->abandoned = true;
}

void HostController::step() {
  const Ticks now = scheduler_.now();
  if (transaction_) finish_transaction();
  client_.between_transactions();
  if (now >= frame_begin_ + frame_ticks_) begin_frame();
  Ticks next = frame_begin_ + frame_ticks_;
  if (frames_run_ && is_polling_ && !transaction_ && busy_pipes_ != 0) {
    if (scheduler_.now() >= bus_free_at_) start_next_transaction();
    if (bus_free_at_ > now) {
      next = std::min(next, bus_free_at_);
    } else {
      for (unsigned i = 0; i < pipe_count; ++i)
        if ((busy_pipes_ & (1u << i)) != 0 && pipes_[i].retry_at > now) next = std::min(next, pipes_[i].retry_at);
    }
  }
  event_ = scheduler_.at(next, [this] { step(); });
}

void HostController::begin_frame() {
  frame_begin_ += frame_ticks_;
  client_.frame();
  if (frames_run_) {
    ++frame_;
    device_.start_of_frame(static_cast<std::uint16_t>(frame_ & 0x7FF));
    bus_free_at_ = frame_begin_ + start_of_frame_bytes * byte_ticks;
  } else if (frames_idle_ < frames_until_suspend && ++frames_idle_ == frames_until_suspend) {
    device_.suspend();
  }
}

void HostController::start_next_transaction() {
  const Ticks now = scheduler_.now();
  for (unsigned i = 1; i < pipe_count; ++i)
    if ((busy_pipes_ & (1u << i)) != 0 && pipes_[i].type == TransferType::interrupt && pipes_[i].due_frame <= frame_ &&
        start(i))
      return;
  if ((busy_pipes_ & 1u) != 0 && pipes_[0].retry_at <= now && start(0)) return;
  for (unsigned turn = 0; turn < pipe_count; ++turn) {
    const unsigned i = (next_bulk_pipe_ + turn) % pipe_count;
    if ((busy_pipes_ & (1u << i)) == 0 || pipes_[i].type != TransferType::bulk || pipes_[i].retry_at > now) continue;
    if (!start(i)) continue;
    next_bulk_pipe_ = (i + 1) % pipe_count;
    return;
  }
}

HostController::Token HostController::next_token(const Urb& urb, TransferType type) {
  if (type != TransferType::control) return urb.in ? Token::in : Token::out;
  switch (urb.stage) {
    case Urb::Stage::setup: return Token::setup;
    case Urb::Stage::data: return urb.in ? Token::in : Token::out;
    default: return urb.in && urb.length > 0 ? Token::out : Token::in;
  }
}

std::uint32_t HostController::next_out_length(const Pipe& pipe, const Urb& urb, Token token) {
  if (token == Token::setup) return 8;
  if (pipe.type == TransferType::control && urb.stage == Urb::Stage::status) return 0;
  return std::min<std::uint32_t>(urb.length - urb.sent, pipe.packet_maximum);
}

std::span<const std::byte> HostController::next_out_data(const Pipe& pipe, const Urb& urb, Token token) {
  if (token == Token::setup) return urb.setup;
  const std::uint32_t length = next_out_length(pipe, urb, token);
  return length == 0 ? std::span<const std::byte>{} : std::span<const std::byte>(urb.data).subspan(urb.sent, length);
}

// Returns false if the transaction is too long for the rest of the frame. The device receives an OUT or SETUP packet at
// the end of a transaction, and an IN token at the start of a transaction.
bool HostController::start(unsigned index) {
  Pipe& pipe = pipes_[index];
  const Urb& urb = pipe.urbs.front();
  const Token token = next_token(urb, pipe.type);
  const Ticks payload = token == Token::in ? pipe.packet_maximum : next_out_length(pipe, urb, token);
  const Ticks now = scheduler_.now();
  const Ticks longest = (transaction_bytes + payload) * byte_ticks + stuffed_bits_maximum(payload) * bit_ticks;
  if (now + longest > frame_begin_ + frame_ticks_) return false;

  Ticks duration = (transaction_bytes + payload) * byte_ticks;
  Transaction transaction{index, token, {}};
  if (token == Token::in) {
    transaction.reply = device_.in(address_, endpoint_of(index), packet_);
    const bool sent = transaction.reply.handshake == Handshake::ack;
    const auto data = std::span<const std::byte>(packet_).first(sent ? transaction.reply.length : 0);
    duration =
        sent ? (transaction_bytes + data.size()) * byte_ticks + stuffed_bits(transaction.reply.data1, data) * bit_ticks
             : refused_in_bytes * byte_ticks;
  } else {
    const bool data1 = token == Token::out && pipe.data1;
    duration += stuffed_bits(data1, next_out_data(pipe, urb, token)) * bit_ticks;
  }
  bus_free_at_ = now + duration;
  transaction_ = transaction;
  return true;
}

void HostController::finish_transaction() {
  const Transaction transaction = *transaction_;
  transaction_.reset();
  const unsigned index = transaction.pipe;
  Pipe& pipe = pipes_[index];
  if (transaction.token == Token::in) {
    InReply reply = transaction.reply;
    if (reply.handshake == Handshake::ack && !device_.finish_in(endpoint_of(index)))
      reply.handshake = Handshake::nothing;
    if (transaction.abandoned) return;
    if (reply.handshake == Handshake::ack)
      handle_in(index, pipe.urbs.front(), reply);
    else
      handle_refusal(index, reply.handshake);
    return;
  }
  if (transaction.abandoned) return;
  Urb& urb = pipe.urbs.front();
  Handshake handshake = Handshake::nothing;
  if (transaction.token == Token::setup) {
    handshake = device_.setup(address_, endpoint_of(index), urb.setup);
  } else {
    handshake = device_.out(address_, endpoint_of(index), pipe.data1, next_out_data(pipe, urb, transaction.token));
  }
  if (handshake == Handshake::ack)
    handle_out(index, urb, transaction.token);
  else
    handle_refusal(index, handshake);
}

void HostController::handle_in(unsigned index, Urb& urb, const InReply& reply) {
  Pipe& pipe = pipes_[index];
  pipe.errors = 0;
  pipe.retry_at = pipe.retry_after = 0;
  if (pipe.type == TransferType::interrupt) pipe.due_frame = frame_ + pipe.interval_frames;
  if (reply.data1 != pipe.data1) return;  // repetition of the previous packet
  pipe.data1 = !pipe.data1;
  const bool control = pipe.type == TransferType::control;
  if (control && urb.stage == Urb::Stage::status) {
    complete(index, reply.length == 0 ? transfer_status::success : transfer_status::overflow);
    return;
  }
  const std::size_t room = urb.length - urb.data.size();
  const std::size_t taken = std::min(room, reply.length);
  urb.data.insert(urb.data.end(), packet_.begin(), packet_.begin() + static_cast<std::ptrdiff_t>(taken));
  if (reply.length > room || reply.length > pipe.packet_maximum) {
    complete(index, transfer_status::overflow);
    return;
  }
  if (reply.length == pipe.packet_maximum && urb.data.size() < urb.length) return;
  if (control) {
    urb.stage = Urb::Stage::status;
    pipe.data1 = true;
    return;
  }
  const bool too_short = urb.data.size() < urb.length && (urb.flags & transfer_flag::short_is_error) != 0;
  complete(index, too_short ? transfer_status::short_packet : transfer_status::success);
}

void HostController::handle_out(unsigned index, Urb& urb, Token token) {
  Pipe& pipe = pipes_[index];
  pipe.errors = 0;
  pipe.retry_at = pipe.retry_after = 0;
  if (pipe.type == TransferType::interrupt) pipe.due_frame = frame_ + pipe.interval_frames;
  if (token == Token::setup) {
    urb.stage = urb.length > 0 ? Urb::Stage::data : Urb::Stage::status;
    pipe.data1 = true;
    return;
  }
  const bool control = pipe.type == TransferType::control;
  if (control && urb.stage == Urb::Stage::status) {
    const bool too_short = urb.data.size() < urb.length && (urb.flags & transfer_flag::short_is_error) != 0;
    complete(index, too_short ? transfer_status::short_packet : transfer_status::success);
    return;
  }
  const std::uint32_t length = next_out_length(pipe, urb, token);
  pipe.data1 = !pipe.data1;
  urb.sent += length;
  if (urb.sent < urb.length) return;
  if (control) {
    urb.stage = Urb::Stage::status;
    pipe.data1 = true;
    return;
  }
  const bool zero_packet_wanted = (urb.flags & transfer_flag::zero_packet) != 0 && length == pipe.packet_maximum;
  if (!zero_packet_wanted) complete(index, transfer_status::success);
}

void HostController::handle_refusal(unsigned index, Handshake handshake) {
  Pipe& pipe = pipes_[index];
  if (handshake == Handshake::stall) {
    complete(index, transfer_status::stalled);
    return;
  }
  if (handshake == Handshake::nothing && ++pipe.errors >= errors_allowed) {
    complete(index, transfer_status::no_answer);
    return;
  }
  if (handshake == Handshake::nak) pipe.errors = 0;
  if (pipe.type == TransferType::interrupt) {
    pipe.due_frame = frame_ + pipe.interval_frames;
    return;
  }
  pipe.retry_after = std::clamp(pipe.retry_after * 2, retry_first, retry_maximum);
  pipe.retry_at = scheduler_.now() + pipe.retry_after;
}

void HostController::complete(unsigned index, std::int32_t status) {
  Pipe& pipe = pipes_[index];
  Urb urb = std::move(pipe.urbs.front());
  pipe.urbs.pop_front();
  if (pipe.urbs.empty()) busy_pipes_ &= ~(1u << index);
  pipe.errors = 0;
  pipe.retry_after = 0;
  // A driver is notified of a completed control transfer at the end of the frame, so the next control transfer starts
  // in the next frame.
  pipe.retry_at = pipe.type == TransferType::control ? frame_begin_ + frame_ticks_ : 0;
  client_.completed(std::move(urb), status);
}

}  // namespace inkwell::virtual_board
