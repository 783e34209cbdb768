#include "server/admission/fair_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace ricochet::server {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;

const FairQueue::Time kNow = FairQueue::Time(seconds(1000));

// A queue whose calls are known by their peer.
struct Queue {
  void Add(const std::string& peer, double expected_s, FairQueue::Time deadline = FairQueue::Time::max()) {
    items.push_back(std::make_unique<FairQueue::Item>());
    items.back()->peer = peer;
    items.back()->expected_s = expected_s;
    items.back()->deadline = deadline;
    queue.Add(*items.back());
  }

  // Lets in the next call, which computes as long as expected, and returns its peer.
  std::string Next() {
    const FairQueue::Item* const item = queue.Next();
    if (item == nullptr) return "nobody";
    queue.Settle(*item, item->expected_s);
    return item->peer;
  }

  FairQueue queue;
  std::vector<std::unique_ptr<FairQueue::Item>> items;
};

TEST(FairQueue, PeersTakeTurnsHoweverManyCallsOneHas) {
  Queue queue;
  for (int i = 0; i < 4; ++i) queue.Add("many", 1.0);
  for (int i = 0; i < 2; ++i) queue.Add("few", 1.0);
  std::vector<std::string> order;
  for (int i = 0; i < 7; ++i) order.push_back(queue.Next());
  EXPECT_THAT(order, ElementsAre("few", "many", "few", "many", "many", "many", "nobody"));
}

TEST(FairQueue, SharesAreOfTimeAndNotOfCalls) {
  Queue queue;
  for (int i = 0; i < 100; ++i) queue.Add("long", 3.0);
  for (int i = 0; i < 100; ++i) queue.Add("short", 1.0);
  std::map<std::string, int> served;
  for (int i = 0; i < 100; ++i) ++served[queue.Next()];
  EXPECT_EQ(served["long"], 25);
  EXPECT_EQ(served["short"], 75);
}

TEST(FairQueue, WhatACallComputedInFactIsSettled) {
  FairQueue queue;
  FairQueue::Item first[2];
  FairQueue::Item second[2];
  for (FairQueue::Item& item : first) item.peer = "a";
  for (FairQueue::Item& item : second) item.peer = "b";
  for (FairQueue::Item* item : {&first[0], &first[1], &second[0], &second[1]}) queue.Add(*item);
  EXPECT_EQ(queue.Next(), &first[0]);
  queue.Settle(first[0], 10.0);
  EXPECT_EQ(queue.Next(), &second[0]);
  queue.Settle(second[0], 1.0);
  EXPECT_EQ(queue.Next(), &second[1]) << "b has computed less";
}

TEST(FairQueue, EarliestDeadlineOfOnePeerGoesFirst) {
  FairQueue queue;
  FairQueue::Item items[4];
  items[0].deadline = kNow + seconds(3);
  items[1].deadline = kNow + seconds(1);
  items[3].deadline = kNow + seconds(1);
  for (FairQueue::Item& item : items) queue.Add(item);
  for (FairQueue::Item* expected : {&items[1], &items[3], &items[0], &items[2]}) EXPECT_EQ(queue.Next(), expected);
}

TEST(FairQueue, PeerThatWasAwayBringsNoCredit) {
  Queue queue;
  for (int i = 0; i < 50; ++i) queue.Add("busy", 1.0);
  for (int i = 0; i < 40; ++i) queue.Next();
  for (int i = 0; i < 10; ++i) queue.Add("back", 1.0);
  std::map<std::string, int> served;
  for (int i = 0; i < 10; ++i) ++served[queue.Next()];
  EXPECT_LE(served["back"], 6) << "half of the turns, and the one that the other peer had last";
  EXPECT_GE(served["back"], 5);
}

TEST(FairQueue, CallsThatGoBeforeAreThoseOfEarlierDeadlinesAndTheSharesOfOthers) {
  Queue queue;
  queue.Add("me", 1.0, kNow + seconds(1));
  queue.Add("me", 2.0, kNow + seconds(9));
  for (int i = 0; i < 100; ++i) queue.Add("other", 1.0);
  queue.Add("small", 0.25);
  FairQueue::Item item;
  item.peer = "me";
  item.expected_s = 0.5;
  item.deadline = kNow + seconds(5);
  // One call of its own is ahead; while that and this one compute, "other" gets as much and "small" all it wants.
  EXPECT_DOUBLE_EQ(queue.queue.ExpectedAhead(item), 1.0 + 1.5 + 0.25);
}

TEST(FairQueue, RemovedCallIsNoLongerWaiting) {
  FairQueue queue;
  FairQueue::Item item;
  queue.Add(item);
  queue.Remove(item);
  EXPECT_EQ(queue.size(), 0U);
  EXPECT_EQ(queue.Next(), nullptr);
}

}  // namespace
}  // namespace ricochet::server
