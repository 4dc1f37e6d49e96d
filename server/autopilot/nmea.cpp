#include "server/autopilot/nmea.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/units/utc_text.hpp"

namespace roadfix::autopilot {
namespace {

std::string sentence(const std::string& body) { return fmt::format("${}*{:02X}\r\n", body, nmea_checksum(body)); }

/// "4807.03800,N" with as many digits of degrees as asked for; 1e-5 minutes are 2 cm.
std::string angle_text(double degrees, int digits, std::string_view signs) {
  const auto units = static_cast<std::int64_t>(std::llround(std::abs(degrees) * 60e5));
  const std::int64_t whole = units / 6'000'000;
  return fmt::format("{:0{}}{:08.5f},{}", whole, digits, static_cast<double>(units % 6'000'000) * 1e-5,
                     degrees < 0.0 ? signs[1] : signs[0]);
}

struct Utc {
  std::string time;  ///< "123519.00"
  std::string date;  ///< "230394"
};

Utc utc_of(std::int64_t time_us) {
  namespace chrono = std::chrono;
  if (time_us < kFirstDateUs) return {};
  const chrono::sys_time<chrono::microseconds> time{chrono::microseconds(time_us)};
  const auto day = chrono::floor<chrono::days>(time);
  const chrono::year_month_day date(day);
  const auto hundredths = chrono::floor<chrono::duration<std::int64_t, std::centi>>(time - day).count();
  return {fmt::format("{:02}{:02}{:02}.{:02}", hundredths / 360'000, hundredths / 6000 % 60, hundredths / 100 % 60,
                      hundredths % 100),
          fmt::format("{:02}{:02}{:02}", static_cast<unsigned>(date.day()), static_cast<unsigned>(date.month()),
                      static_cast<int>(date.year()) % 100)};
}

}  // namespace

std::uint8_t nmea_checksum(std::string_view sentence) {
  std::uint8_t sum = 0;
  for (const char c : sentence) sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  return sum;
}

std::string nmea_sentences(const PositionReport& report, int satellites) {
  const auto [time, date] = utc_of(report.captured_us);
  if (!report.position) {
    return sentence(fmt::format("GPGGA,{},,,,,0,{:02},,,,,,,", time, 0)) +
           sentence(fmt::format("GPRMC,{},V,,,,,,,{},,,N", time, date));
  }
  const Position& position = *report.position;
  const std::string place = angle_text(position.at.lat_deg, 2, "NS") + "," + angle_text(position.at.lon_deg, 3, "EW");
  const std::string height = report.altitude_msl_m ? fmt::format("{:.1f},M", *report.altitude_msl_m) : ",";
  std::string text = sentence(fmt::format("GPGGA,{},{},6,{:02},,{},,,,", time, place, satellites, height)) +
                     sentence(fmt::format("GPRMC,{},A,{},,,{},,,E", time, place, date));
  if (position.sigma_m) {
    text += sentence(fmt::format("GPGST,{},,,,,{:.1f},{:.1f},", time, *position.sigma_m, *position.sigma_m));
  }
  return text;
}

}  // namespace roadfix::autopilot
