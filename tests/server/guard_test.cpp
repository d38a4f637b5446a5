// Who is answered, and which bytes.
#include "server/guard.h"

#include <gtest/gtest.h>

namespace tailwater {
namespace {

TEST(Guard, TokensAreLongAndDiffer) {
  const std::string token = random_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(token, random_token());
  EXPECT_TRUE(is_token(token, token));
  EXPECT_FALSE(is_token("", token));
  EXPECT_FALSE(is_token(token + "0", token));
  EXPECT_FALSE(is_token(token.substr(0, 31), token));
  for (std::size_t k = 0; k < token.size(); ++k) {
    std::string other = token;
    other[k] = other[k] == 'a' ? 'b' : 'a';
    EXPECT_FALSE(is_token(other, token));
  }
}

TEST(Guard, OnlyThisMachineIsAHost) {
  for (const char* host : {"127.0.0.1", "127.0.0.1:8080", "localhost:1", "localhost", "[::1]:99"}) {
    EXPECT_TRUE(is_own_host(host)) << host;
  }
  for (const char* host : {"", "example.org", "localhost.example.org", "127.0.0.1.example.org",
                           "127.0.0.1:", "localhost:x", "127.0.0.2", "evil:80"}) {
    EXPECT_FALSE(is_own_host(host)) << host;
  }
}

TEST(Guard, OnlyItsOwnPageIsAnOrigin) {
  EXPECT_TRUE(is_own_origin("", "127.0.0.1:8080"));
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
  for (const char* origin : {"null", "http://example.org", "http://127.0.0.1:8081", "https://127.0.0.1:8080"}) {
    EXPECT_FALSE(is_own_origin(origin, "127.0.0.1:8080")) << origin;
  }
}

TEST(Guard, RangesStayInTheFile) {
  struct Case {
    const char* header;
    RangeAnswer answer;
    long long first, last;
  };
  const Case cases[] = {
      {"bytes=0-9", RangeAnswer::part, 0, 9},
      {"bytes=90-", RangeAnswer::part, 90, 99},
      {"bytes=90-1000", RangeAnswer::part, 90, 99},
      {"bytes=-10", RangeAnswer::part, 90, 99},
      {"bytes=-1000", RangeAnswer::part, 0, 99},
      {"bytes=99-99", RangeAnswer::part, 99, 99},
      {"bytes=100-", RangeAnswer::impossible, 0, -1},
      {"bytes=-0", RangeAnswer::impossible, 0, -1},
      {"bytes=999999999999999999-", RangeAnswer::impossible, 0, -1},
      {"", RangeAnswer::whole, 0, -1},
      {"bytes=", RangeAnswer::whole, 0, -1},
      {"bytes=9-0", RangeAnswer::whole, 0, -1},
      {"bytes=0-1,5-6", RangeAnswer::whole, 0, -1},
      {"bytes=99999999999999999999-", RangeAnswer::whole, 0, -1},
      {"lines=0-1", RangeAnswer::whole, 0, -1},
  };
  for (const auto& [header, answer, first, last] : cases) {
    ByteRange range;
    EXPECT_EQ(range_of(header, 100, range), answer) << header;
    EXPECT_EQ(range.first, first) << header;
    EXPECT_EQ(range.last, last) << header;
  }
  ByteRange range;
  EXPECT_EQ(range_of("bytes=0-", 0, range), RangeAnswer::impossible);
}

}  // namespace
}  // namespace tailwater
