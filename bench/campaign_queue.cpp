// How long a campaign takes on a cluster whose nodes fail: a simulation of the
// queue, for docs/scale.md. No mission is driven. campaign_queue MISSIONS SECONDS_A_MISSION
// MISSIONS_A_TASK NODES CORES_A_NODE HOURS_BETWEEN_FAILURES

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <queue>
#include <random>
#include <vector>

namespace {

struct Cluster {
  double missions;
  double mission_s;
  double task_missions;
  int nodes;
  int cores;                 ///< of a node
  double failure_h;          ///< mean time between failures of a node
  double dispatch_s = 0.42;  ///< Slurm 22.05 started 100 tasks in 42 s
  double start_s = 1.0;      ///< of a process with its missions
  double notice_s = 450.0;   ///< SlurmdTimeout (300 s) and the requeue's delay (150 s)
  double repair_s = 3600.0;
  double spread = 0.1;  ///< standard deviation of the nodes' speeds
};

struct Outcome {
  double hours = 0.0;
  long failures = 0;
  long requeued = 0;
  long under_way = 0;  ///< missions that a node's failure cut off
};

enum class Kind { finish, failure, repaired, requeue };

struct Event {
  double at_s;
  Kind kind;
  int node;
  int task;
  int life;  ///< of the node: what was begun in an earlier one is void
  bool operator<(const Event& other) const { return at_s > other.at_s; }
};

class Queue {
 public:
  Queue(const Cluster& cluster, std::uint64_t seed) : cluster_(cluster), random_(seed) {
    const auto tasks = static_cast<int>(std::ceil(cluster.missions / cluster.task_missions));
    left_.assign(static_cast<std::size_t>(tasks), cluster.task_missions);
    for (int i = 0; i < tasks; ++i) waiting_.push_back(i);
    nodes_.resize(static_cast<std::size_t>(cluster.nodes));
    std::normal_distribution<> speed(1.0, cluster.spread);
    for (int i = 0; i < cluster.nodes; ++i) {
      node(i).idle = cluster.cores;
      node(i).speed = std::max(0.5, speed(random_));
      events_.push({next_failure(0.0), Kind::failure, i, 0, 0});
    }
  }

  Outcome run() {
    Outcome outcome;
    auto open = left_.size();
    dispatch(0.0);
    while (open > 0) {
      const Event event = events_.top();
      events_.pop();
      Node& there = node(event.node);
      switch (event.kind) {
        case Kind::finish:
          if (event.life != there.life) break;
          ++there.idle;
          there.running.erase(std::find_if(there.running.begin(), there.running.end(),
                                           [&](const Run& r) { return r.task == event.task; }));
          --open;
          outcome.hours = event.at_s / 3600.0;
          break;
        case Kind::failure:
          ++outcome.failures;
          fail(event, outcome);
          break;
        case Kind::repaired:
          there.idle = cluster_.cores;
          events_.push({next_failure(event.at_s), Kind::failure, event.node, 0, 0});
          break;
        case Kind::requeue:
          waiting_.push_front(event.task);
          break;
      }
      dispatch(event.at_s);
    }
    return outcome;
  }

 private:
  struct Run {
    int task;
    double begun_s;
  };
  struct Node {
    int idle = 0;
    int life = 0;
    double speed = 1.0;
    std::vector<Run> running;
  };

  Node& node(int i) { return nodes_[static_cast<std::size_t>(i)]; }
  double next_failure(double now) {
    return now + std::exponential_distribution<>(1.0 / (cluster_.failure_h * 3600.0))(random_);
  }

  /// Finished missions of the tasks that ran there stay; those under way are driven again.
  void fail(const Event& event, Outcome& outcome) {
    Node& there = node(event.node);
    for (const Run& run : there.running) {
      const double drove_s = std::max(0.0, event.at_s - run.begun_s - cluster_.start_s);
      const double done = std::floor(drove_s * there.speed / cluster_.mission_s);
      auto& left = left_[static_cast<std::size_t>(run.task)];
      left = std::max(1.0, left - done);
      events_.push({event.at_s + cluster_.notice_s, Kind::requeue, event.node, run.task, 0});
      ++outcome.requeued;
      ++outcome.under_way;
    }
    there.running.clear();
    there.idle = 0;
    ++there.life;
    events_.push({event.at_s + cluster_.repair_s, Kind::repaired, event.node, 0, 0});
  }

  void dispatch(double now) {
    for (int i = 0; i < cluster_.nodes && !waiting_.empty(); ++i) {
      Node& there = node(i);
      for (; there.idle > 0 && !waiting_.empty(); --there.idle) {
        const int task = waiting_.front();
        waiting_.pop_front();
        free_s_ = std::max(free_s_, now) + cluster_.dispatch_s;
        there.running.push_back({task, free_s_});
        const double takes_s = cluster_.start_s + left_[static_cast<std::size_t>(task)] *
                                                      cluster_.mission_s / there.speed;
        events_.push({free_s_ + takes_s, Kind::finish, i, task, there.life});
      }
    }
  }

  Cluster cluster_;
  std::mt19937_64 random_;
  std::vector<double> left_;  ///< missions of each task
  std::deque<int> waiting_;
  std::vector<Node> nodes_;
  std::priority_queue<Event> events_;
  double free_s_ = 0.0;  ///< when the controller can start the next task
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fputs(
        "usage: campaign_queue MISSIONS SECONDS_A_MISSION MISSIONS_A_TASK NODES "
        "CORES_A_NODE HOURS_BETWEEN_FAILURES\n",
        stderr);
    return 2;
  }
  const Cluster cluster{std::atof(argv[1]), std::atof(argv[2]), std::atof(argv[3]),
                        std::atoi(argv[4]), std::atoi(argv[5]), std::atof(argv[6])};
  if (cluster.missions < 1 || !(cluster.mission_s > 0) || cluster.task_missions < 1 ||
      cluster.nodes < 1 || cluster.cores < 1 || !(cluster.failure_h > 0)) {
    std::fputs("campaign_queue: every number must be greater than nothing\n", stderr);
    return 2;
  }
  const double ideal_h =
      cluster.missions * cluster.mission_s / (cluster.nodes * cluster.cores) / 3600.0;
  std::printf("tasks %.0f of %.1f min; ideal %.2f h\n",
              std::ceil(cluster.missions / cluster.task_missions),
              cluster.task_missions * cluster.mission_s / 60.0, ideal_h);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Outcome o = Queue(cluster, seed).run();
    std::printf(
        "seed %d: %.2f h (%.0f %% of the ideal's speed), %ld failures, %ld tasks requeued, "
        "%ld missions cut off\n",
        static_cast<int>(seed), o.hours, 100.0 * ideal_h / o.hours, o.failures, o.requeued,
        o.under_way);
  }
  return 0;
}
