#include "cli/terminal.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <thread>
#include <utility>

namespace roadfix::cli {

std::stop_token stop_on_signals() {
  // A thread of its own waits for the signals: nothing but async-signal-safe code may run in a handler.
  static std::stop_source source;
  static const bool started = [] {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    struct sigaction hangup {};
    sigaction(SIGHUP, nullptr, &hangup);
    if (hangup.sa_handler != SIG_IGN) sigaddset(&set, SIGHUP);  // nohup ignores it
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    std::thread([set] {
      int signal = 0;
      sigwait(&set, &signal);
      source.request_stop();
      sigwait(&set, &signal);
      _exit(128 + signal);
    }).detach();
    return true;
  }();
  (void)started;
  return source.get_token();
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

std::function<void(std::int64_t done, std::int64_t total)> Progress::updates() {
  return [this](std::int64_t done, std::int64_t total) { update(done, total); };
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
