#include "cli/terminal.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <thread>
#include <utility>

namespace roadfix::cli {

namespace {

struct Stop {
  std::stop_source source;
  std::atomic<bool> is_awaited = false;  ///< by a command that stops in good order
};

/// Never destroyed: a signal may come while the process ends.
Stop& stop() {
  static Stop& instance = *new Stop;
  return instance;
}

sigset_t watched_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaddset(&set, SIGHUP);  // nohup ignores it
  return set;
}

/// As if nobody had waited for it: whoever started the process sees what ended it. Returns where it is ignored.
void end_by(int signal) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  raise(signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

[[noreturn]] void wait_for(const sigset_t& signals) {
  for (;;) {
    int signal = 0;
    sigwait(&signals, &signal);
    if (!stop().is_awaited) {
      end_by(signal);
    } else if (!stop().source.request_stop()) {
      _exit(128 + signal);
    }
  }
}

}  // namespace

void watch_signals() {
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGXFSZ, SIG_IGN);
  // A thread of its own waits for them: nothing but async-signal-safe code may run in a handler.
  std::thread([signals] { wait_for(signals); }).detach();
}

std::stop_token stop_on_signals() {
  stop().is_awaited = true;
  return stop().source.get_token();
}

Progress::Progress(std::string task, std::string unit, double units_per_item)
    : task_(std::move(task)),
      unit_(std::move(unit)),
      units_per_item_(units_per_item),
      terminal_(isatty(STDERR_FILENO) == 1),
      started_(Clock::now()) {}

Progress::~Progress() {
  if (line_open_) std::fputc('\n', stderr);
}

void Progress::update(std::int64_t done, std::int64_t total) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (first_done_ < 0) {
    first_done_ = done;
    started_ = now;
  }
  const auto interval = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10'000);
  if (done < total && now - last_print_ < interval) return;
  last_print_ = now;
  print(done, total);
}

OnProgress Progress::updates() {
  return [this](std::int64_t done, std::int64_t total) { update(done, total); };
}

OnProgress Progress::updates_if_long() {
  constexpr std::chrono::seconds kQuiet{2};
  return [this, loud = Clock::now() + kQuiet](std::int64_t done, std::int64_t total) {
    if (Clock::now() >= loud) update(done, total);
  };
}

void Progress::print(std::int64_t done, std::int64_t total) {
  const double seconds = std::chrono::duration<double>(Clock::now() - started_).count();
  const auto items = static_cast<double>(done - first_done_);
  const double rate = seconds > 0.0 ? items / seconds : 0.0;
  const double share = total > 0 ? 100.0 * static_cast<double>(done) / static_cast<double>(total) : 100.0;
  std::string line =
      fmt::format("{} {:5.1f} %  {}/{}  {:.2f} {}/s", task_, share, done, total, rate * units_per_item_, unit_);
  if (done < total && rate > 0.0) {
    const auto left = static_cast<std::int64_t>(static_cast<double>(total - done) / rate);
    line += fmt::format("  {}:{:02}:{:02} left", left / 3600, left / 60 % 60, left % 60);
  }
  std::fputs((terminal_ ? "\r" + line + "\033[K" : line + "\n").c_str(), stderr);
  std::fflush(stderr);
  line_open_ = terminal_;
}

}  // namespace roadfix::cli
