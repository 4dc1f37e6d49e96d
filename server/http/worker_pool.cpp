#include "server/http/worker_pool.hpp"

#include <algorithm>
#include <utility>

namespace roadfix::http {
namespace {

thread_local bool t_overflow = false;

}  // namespace

WorkerPool::WorkerPool(std::size_t threads, std::size_t max_waiting) : max_waiting_(max_waiting) {
  try {
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  } catch (...) {
    shutdown();  // those that run wait for work, and would be waited for
    throw;
  }
}

WorkerPool::~WorkerPool() { shutdown(); }

void WorkerPool::enqueue(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    if (jobs_.size() < max_waiting_) {
      jobs_.push_back(std::move(job));
      wake_.notify_one();
      return;
    }
  }
  t_overflow = true;
  job();
  t_overflow = false;
}

void WorkerPool::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  threads_.clear();
}

std::size_t WorkerPool::waiting() const {
  const std::lock_guard lock(mutex_);
  return jobs_.size() - std::min(jobs_.size(), idle_);
}

bool WorkerPool::overflow() { return t_overflow; }

void WorkerPool::work() {
  for (;;) {
    std::function<void()> job;
    {
      std::unique_lock lock(mutex_);
      ++idle_;
      wake_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
      --idle_;
      if (jobs_.empty()) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    job();
  }
}

}  // namespace roadfix::http
