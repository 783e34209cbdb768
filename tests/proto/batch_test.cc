// Batches on the wire: the bytes of columns, and answers that do not fit.

#include "proto/wire/batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/error.h"

namespace ricochet {
namespace {

using testing::ElementsAre;

// 1.0, -2.5 and the smallest double above 0, as IEEE 754 writes them, the lowest byte first.
const std::string kBytes(
    "\0\0\0\0\0\0\xf0\x3f"
    "\0\0\0\0\0\0\x04\xc0"
    "\1\0\0\0\0\0\0\0",
    24);

TEST(BatchExchangeTest, ReadsColumnsAsLittleEndianDoubles) {
  v1::SolveBatchRequest request;
  request.add_inputs(kBytes);
  request.add_inputs(kBytes.substr(8));
  BatchExchange exchange;
  ASSERT_TRUE(exchange.OpenInputs(request).ok());
  EXPECT_EQ(exchange.row_count(), 3U);
  ASSERT_EQ(exchange.rows().inputs.size(), 2U);
  EXPECT_THAT(exchange.rows().inputs[0], ElementsAre(1.0, -2.5, 4.9406564584124654e-324));
  EXPECT_THAT(exchange.rows().inputs[1], ElementsAre(-2.5, 4.9406564584124654e-324));
}

TEST(BatchExchangeTest, NamesAColumnThatIsNoListOfDoubles) {
  v1::SolveBatchRequest request;
  request.add_inputs(kBytes);
  request.add_inputs(kBytes.substr(0, 9));
  BatchExchange exchange;
  EXPECT_THAT(ViolationsOf(exchange.OpenInputs(request)),
              ElementsAre(Violation{"inputs[1]", "has 9 bytes: must have 8 for each row"}));
}

TEST(BatchExchangeTest, WritesTheAnswerIntoTheMessage) {
  v1::SolveBatchRequest request;
  request.add_inputs(kBytes);
  BatchExchange exchange;
  v1::SolveBatchResponse response;
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(exchange.OpenInputs(request).ok());
    exchange.OpenOutputs(1, response);
    const std::vector<double> numbers = {1.0, -2.5, 4.9406564584124654e-324};
    const std::vector<Regime> regimes = {Regime::kSliding, Regime::kInvalid, Regime::kLocked};
    const std::vector<RowStatus> statuses = {RowStatus::kOk, RowStatus::kInvalid, RowStatus::kInadmissible};
    for (size_t i = 0; i < 3; ++i) {
      exchange.rows().outputs[0][i] = numbers[i];
      exchange.rows().regimes[i] = regimes[i];
      exchange.rows().statuses[i] = statuses[i];
    }
    exchange.Close({}, {}, response);
    ASSERT_EQ(response.outputs_size(), 1);
    EXPECT_EQ(response.outputs(0), kBytes);
    EXPECT_EQ(response.regimes(), "\x03\x0b\x08");
    EXPECT_EQ(response.statuses(), "\x01\x03\x02");
  }
}

TEST(CopyOutputsTest, RefusesAnAnswerThatDoesNotFit) {
  std::vector<double> numbers(3);
  BatchRows rows;
  rows.outputs = {absl::MakeSpan(numbers)};
  v1::SolveBatchResponse response;
  response.add_outputs(kBytes);
  response.set_regimes("\x03\x03\x03");
  response.set_statuses("\x01\x01\x01");
  EXPECT_TRUE(CopyOutputs(response, 0, 3, rows).ok());
  EXPECT_THAT(numbers, ElementsAre(1.0, -2.5, 4.9406564584124654e-324));
  const auto broken = [&](auto change) {
    v1::SolveBatchResponse bad = response;
    change(bad);
    return CopyOutputs(bad, 0, 3, rows).code();
  };
  EXPECT_EQ(broken([](auto& bad) { bad.add_outputs(kBytes); }), absl::StatusCode::kDataLoss);
  EXPECT_EQ(broken([](auto& bad) { bad.mutable_outputs(0)->resize(16); }), absl::StatusCode::kDataLoss);
  EXPECT_EQ(broken([](auto& bad) { bad.set_regimes("\x03"); }), absl::StatusCode::kDataLoss);
  EXPECT_EQ(broken([](auto& bad) { bad.clear_statuses(); }), absl::StatusCode::kDataLoss);
  EXPECT_EQ(broken([](auto& bad) { bad.mutable_summary()->add_bad_rows()->set_row(3); }), absl::StatusCode::kDataLoss);
  EXPECT_EQ(broken([](auto& bad) { bad.mutable_summary()->add_bad_rows()->set_row(-1); }), absl::StatusCode::kDataLoss);
  EXPECT_EQ(broken([](auto& bad) { bad.mutable_summary()->add_bad_rows()->set_row(2); }), absl::StatusCode::kOk);
}

TEST(CopyOutputsTest, TakesAStatusThatThisBuildDoesNotKnowAsUnspecified) {
  std::vector<double> numbers(1);
  std::vector<Regime> regimes(1);
  std::vector<RowStatus> statuses(1);
  BatchRows rows = {
      .outputs = {absl::MakeSpan(numbers)}, .regimes = absl::MakeSpan(regimes), .statuses = absl::MakeSpan(statuses)};
  v1::SolveBatchResponse response;
  response.add_outputs(kBytes.substr(0, 8));
  response.set_regimes("\xff");
  response.set_statuses("\xff");
  ASSERT_TRUE(CopyOutputs(response, 0, 1, rows).ok());
  EXPECT_EQ(regimes[0], Regime::kUnspecified);
  EXPECT_EQ(statuses[0], RowStatus::kUnspecified);
}

}  // namespace
}  // namespace ricochet
