#pragma once

namespace vigia::report {

struct Colour {
  double r = 0.0;
  double g = 0.0;
  double b = 0.0;
  double alpha = 1.0;

  constexpr Colour with_alpha(double value) const { return {r, g, b, value}; }
};

/// Okabe and Ito's palette, which stays distinct under the common colour-vision deficiencies, and
/// greys.
namespace palette {

constexpr Colour hex(unsigned rgb) {
  return {static_cast<double>((rgb >> 16U) & 0xffU) / 255.0,
          static_cast<double>((rgb >> 8U) & 0xffU) / 255.0,
          static_cast<double>(rgb & 0xffU) / 255.0};
}

inline constexpr Colour kBlack = hex(0x000000);
inline constexpr Colour kWhite = hex(0xffffff);
inline constexpr Colour kOrange = hex(0xe69f00);
inline constexpr Colour kSkyBlue = hex(0x56b4e9);
inline constexpr Colour kGreen = hex(0x009e73);
inline constexpr Colour kBlue = hex(0x0072b2);
inline constexpr Colour kVermillion = hex(0xd55e00);
inline constexpr Colour kPurple = hex(0xcc79a7);
inline constexpr Colour kInk = hex(0x222222);
inline constexpr Colour kMuted = hex(0x666666);
inline constexpr Colour kTruth = hex(0x8c8c8c);
inline constexpr Colour kGrid = hex(0xe3e3e3);
inline constexpr Colour kSolid = hex(0xd9d9d9);

}  // namespace palette
}  // namespace vigia::report
