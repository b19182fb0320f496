#include "host/bindings/library/turns.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

namespace inkwell::library {

std::shared_ptr<Turns> Turns::of_own_boards() {
  static std::mutex mutex;
  static std::weak_ptr<Turns> newest;
  static pid_t process = 0;
  const std::lock_guard lock(mutex);
  auto turns = newest.lock();
  const bool is_of_parent = std::exchange(process, getpid()) != getpid();  // the child does not read the boards of its
                                                                           // parent
  if (!turns || is_of_parent) newest = turns = std::make_shared<Turns>();
  return turns;
}

// ---- boards -------------------------------------------------------------------------------------------------

Turns::Board::Board(std::shared_ptr<Turns> turns, bool is_stepped)
    : turns_(std::move(turns)), is_stepped_(is_stepped) {}

Turns::Board::~Board() { leave(); }

bool Turns::is_stepped() const { return std::ranges::any_of(boards_, &Board::is_stepped_); }

void Turns::forget_late_answers(std::chrono::milliseconds waited) {
  const Patience& limit = is_stepped() ? patience_if_stepped : patience;
  std::erase_if(answering_,
                [&](const auto& entry) { return waited >= (entry.second == Answer::loop ? limit.loop : limit.servo); });
}

bool Turns::may_begin() const {
  const bool is_wanted = !is_stepped() || waiting_ > 0 || std::ranges::any_of(boards_, &Board::is_opening_);
  return is_wanted && answering_.empty() && std::ranges::all_of(boards_, &Board::is_ready_);
}

void Turns::begin_turn() {
  for (Board* board : boards_) {
    board->is_ready_ = false;
    board->is_in_turn_ = true;
    board->met_ = 0;
  }
  ++turn_;
  changed_.notify_all();
}

void Turns::Board::let_program_decide() {
  const std::lock_guard lock(turns_->mutex_);
  is_opening_ = false;
}

bool Turns::Board::begin() {
  std::unique_lock lock(turns_->mutex_);
  if (has_left_) return false;
  turns_->boards_.insert(this);
  is_ready_ = true;
  const std::uint64_t turn_before = turns_->turn_;
  const auto goes_on = [&] { return has_left_ || turns_->turn_ != turn_before || turns_->may_begin(); };
  for (auto waited = patience.loop; !turns_->changed_.wait_for(lock, patience.loop, goes_on); waited += patience.loop)
    turns_->forget_late_answers(waited);
  if (has_left_) return false;
  if (turns_->turn_ == turn_before) turns_->begin_turn();
  return true;
}

bool Turns::Board::meet() {
  std::unique_lock lock(turns_->mutex_);
  const unsigned mine = ++met_;
  turns_->changed_.notify_all();
  turns_->changed_.wait(lock, [&] {
    return has_left_ || std::ranges::all_of(turns_->boards_, [&](const Board* board) {
             return !board->is_in_turn_ || board->met_ >= mine;
           });
  });
  return !has_left_;
}

bool Turns::Board::wait_for_servos() {
  std::unique_lock lock(turns_->mutex_);
  const auto is_servo = [](const auto& entry) { return entry.second == Answer::servo; };
  const auto goes_on = [&] { return has_left_ || std::ranges::none_of(turns_->answering_, is_servo); };
  for (auto waited = patience.loop; !turns_->changed_.wait_for(lock, patience.loop, goes_on); waited += patience.loop)
    turns_->forget_late_answers(waited);
  return !has_left_;
}

void Turns::Board::end() {
  const std::lock_guard lock(turns_->mutex_);
  is_in_turn_ = false;
  turns_->changed_.notify_all();
}

void Turns::Board::pause() {
  const std::lock_guard lock(turns_->mutex_);
  turns_->boards_.erase(this);
  is_ready_ = is_in_turn_ = false;
  is_opening_ = true;
  turns_->changed_.notify_all();
}

void Turns::Board::leave() {
  const std::lock_guard lock(turns_->mutex_);
  has_left_ = true;
  turns_->boards_.erase(this);
  turns_->changed_.notify_all();
}

// ---- callers ------------------------------------------------------------------------------------------------

void Turns::begin_answer(std::thread::id thread, Answer answer) {
  const std::lock_guard lock(mutex_);
  if (is_waited_for(answer)) answering_[thread] = answer;
}

void Turns::end_answer(std::thread::id thread) {
  const std::lock_guard lock(mutex_);
  answering_.erase(thread);
  changed_.notify_all();
}

Turns::Answer Turns::begin_waiting(std::thread::id thread) {
  const std::lock_guard lock(mutex_);
  ++waiting_;
  const auto answer = answering_.find(thread);
  const Answer before = answer == answering_.end() ? Answer::none : answer->second;
  if (answer != answering_.end()) answering_.erase(answer);
  changed_.notify_all();
  return before;
}

void Turns::end_waiting(std::thread::id thread, Answer answer) {
  const std::lock_guard lock(mutex_);
  --waiting_;
  if (is_waited_for(answer)) answering_[thread] = answer;
}

}  // namespace inkwell::library
