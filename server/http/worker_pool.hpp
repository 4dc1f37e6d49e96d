// Threads that each serve one connection at a time. Connections beyond the threads wait in a bounded queue.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace roadfix::http {

class WorkerPool {
 public:
  /// Throws std::system_error where the system gives fewer threads.
  WorkerPool(std::size_t threads, std::size_t max_waiting);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Runs the job at once, in the caller's thread and with `overflow()` set, when the queue is full.
  void enqueue(std::function<void()> job);
  /// Runs what waits, then joins.
  void shutdown();

  /// Jobs for which there is no idle thread.
  std::size_t waiting() const;
  /// The job that runs in this thread got no thread of its own and must end at once.
  static bool overflow();

 private:
  void work();

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  std::size_t idle_ = 0;  ///< threads
  const std::size_t max_waiting_;
  bool stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace roadfix::http
