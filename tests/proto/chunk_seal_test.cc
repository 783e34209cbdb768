// The checksum and the fingerprint of chunks, as ricochet.v1.SweepResponse defines them.

#include "proto/wire/chunk_seal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>

#include "fill.h"
#include "proto/wire/sweep.h"

namespace ricochet {
namespace {

// A chunk whose values have the bytes first, first + step, ... 32 bytes in all.
v1::SweepResponse ValuesOfBytes(uint8_t first, int step) {
  v1::SweepResponse chunk;
  for (int i = 0; i < 32; ++i) chunk.mutable_values()->push_back(static_cast<char>(first + step * i));
  return chunk;
}

// The four examples of 32 bytes in RFC 3720, appendix B.4.
TEST(Crc32c, GivesTheExamplesOfItsStandard) {
  EXPECT_EQ(Crc32cOf(ValuesOfBytes(0, 0)), 0x8a9136aa);
  EXPECT_EQ(Crc32cOf(ValuesOfBytes(0xff, 0)), 0x62a8ab43);
  EXPECT_EQ(Crc32cOf(ValuesOfBytes(0, 1)), 0x46dd794e);
  EXPECT_EQ(Crc32cOf(ValuesOfBytes(31, -1)), 0x113fdb5c);
}

TEST(Crc32c, GoesOnOverTheRegimesAndTheStatuses) {
  v1::SweepResponse chunk = ValuesOfBytes(0, 1);
  chunk.set_regimes(chunk.values().substr(16, 10));
  chunk.set_statuses(chunk.values().substr(26));
  chunk.mutable_values()->resize(16);
  EXPECT_EQ(Crc32cOf(chunk), 0x46dd794e);
}

TEST(Crc32c, OfNoDataIsZero) { EXPECT_EQ(Crc32cOf({}), 0); }

SweepRequest FilledRequest(int choice) {
  v1::SweepRequest request;
  Fill(choice, request);
  return FromProto(request);
}

TEST(GridFingerprint, IsThatOfTheRequestWithoutItsRange) {
  SweepRequest request = FilledRequest(0);
  const std::string fingerprint = GridFingerprint(request);
  EXPECT_THAT(fingerprint, testing::MatchesRegex("[0-9a-f]{16}"));
  request.first_index = 7;
  request.end_index.reset();
  EXPECT_EQ(GridFingerprint(request), fingerprint);
}

TEST(GridFingerprint, ChangesWithEveryOtherField) {
  std::set<std::string> fingerprints;
  const v1::SweepRequest whole = ToProto(FilledRequest(0));
  const google::protobuf::Descriptor& type = *v1::SweepRequest::descriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    v1::SweepRequest request = whole;
    request.GetReflection()->ClearField(&request, type.field(i));
    fingerprints.insert(GridFingerprint(FromProto(request)));
  }
  // The whole request is there once, because clearing either end of the range does not change it.
  EXPECT_EQ(fingerprints.size(), static_cast<size_t>(type.field_count() - 1));
  // Requests that choose other members of each oneof differ as well.
  for (int choice = 1; choice < 4; ++choice)
    EXPECT_TRUE(fingerprints.insert(GridFingerprint(FilledRequest(choice))).second);
}

}  // namespace
}  // namespace ricochet
