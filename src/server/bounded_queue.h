// Threads that answer, at their maximum number, and a bounded queue whose producer waits when it is full. So the number
// of open connections is limited to those of the queue and the threads.
#pragma once

#include <httplib.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tailwater {

class BoundedQueue : public httplib::TaskQueue {
 public:
  BoundedQueue(std::size_t threads, std::size_t room) : room_(room) {
    for (std::size_t k = 0; k < threads; ++k) {
      threads_.emplace_back([this] { work(); });
    }
  }

  void enqueue(std::function<void()> job) override {
    std::unique_lock lock(mutex_);
    has_room_.wait(lock, [this] { return jobs_.size() < room_ || is_ending_; });
    jobs_.push_back(std::move(job));
    lock.unlock();
    has_job_.notify_one();
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
    }
    has_job_.notify_all();
    has_room_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void work() {
    while (true) {
      std::unique_lock lock(mutex_);
      has_job_.wait(lock, [this] { return !jobs_.empty() || is_ending_; });
      if (jobs_.empty()) return;
      const std::function<void()> job = std::move(jobs_.front());
      jobs_.pop_front();
      lock.unlock();
      has_room_.notify_one();
      job();
    }
  }

  std::size_t room_;
  std::vector<std::thread> threads_;
  std::deque<std::function<void()>> jobs_;
  std::mutex mutex_;
  std::condition_variable has_job_;
  std::condition_variable has_room_;
  bool is_ending_ = false;
};

}  // namespace tailwater
