#include <doctest/doctest.h>

#include "boards/omni_driver/facts.hpp"
#include "host/client/device/fault_text.hpp"

using namespace inkwell;
using protocol::Fault;

TEST_CASE("every fault's text gets its figures, and no brace is left") {
  for (const auto& row : protocol::fault_table) {
    CAPTURE(row.name);
    const auto text = device::fault_text(static_cast<Fault>(row.code));
    CHECK((text.cause + text.remedy).find_first_of("{}") == std::string::npos);
    CHECK(device::fault_line(static_cast<Fault>(row.code)) ==
          std::string(row.name) + ": " + text.cause + " " + text.remedy);
  }
}

TEST_CASE("the supply's faults name the limits at which the firmware switches off") {
  CHECK(device::fault_text(Fault::supply_low).cause == "The supply of the bridges is below 12 V.");
  CHECK(device::fault_text(Fault::supply_low).remedy == "Check the 18 V supply and its fuse, then clear the fault.");
  CHECK(device::fault_text(Fault::supply_high).cause == "The supply of the bridges is above 24 V.");
  CHECK(device::fault_text(Fault::current_sensor).remedy.find("the 1.65 V reference") != std::string::npos);
}

TEST_CASE("the texts of supply_ripple and analog_supply state the tolerated deviation") {
  CHECK(device::fault_text(Fault::supply_ripple).cause ==
        "The ripple of the bridge supply repeatedly exceeds 1 V in either direction.");
  CHECK(device::fault_text(Fault::analog_supply).cause.find("differs by more than 5 % from 3.3 V") !=
        std::string::npos);
}

TEST_CASE("the texts of the motor faults and of samples_stale contain the limits of the firmware") {
  CHECK(device::fault_text(Fault::over_current).cause.find("exceeded 150 % of its limit") != std::string::npos);
  CHECK(
      device::fault_text(Fault::samples_stale).cause ==
      "A motor current was not measured in a control period, or the supply and the gimbal were not measured for 1 ms.");
  CHECK(device::fault_text(Fault::motor_hot).cause.find("is 25 % above its thermal limit") != std::string::npos);
  CHECK(device::fault_text(Fault::motor_hot).remedy.find("cool below 85 %.") != std::string::npos);
}

TEST_CASE("the text of a failed self-test contains its items and their remedies once") {
  using protocol::SelfTestItem;
  using protocol::SelfTestResult;
  protocol::SelfTestReport test{};
  const auto set = [&](SelfTestItem item, SelfTestResult result) {
    test.entries[static_cast<std::size_t>(item)].result = result;
  };
  CHECK(device::fault_text(Fault::self_test_failed, test).cause == device::fault_text(Fault::self_test_failed).cause);
  set(SelfTestItem::motor_1, SelfTestResult::failed);
  set(SelfTestItem::motor_3, SelfTestResult::failed);
  set(SelfTestItem::encoder_2_a, SelfTestResult::moved);
  set(SelfTestItem::gimbal_1, SelfTestResult::failed);  // the gimbal is not needed for forces
  const auto text = device::fault_text(Fault::self_test_failed, test);
  CHECK(text.cause == "The self-test failed for items that the force needs: motor_1, motor_3.");
  CHECK(text.remedy == std::string(info(SelfTestItem::motor_1).remedy) + " Then clear the fault, which tests again.");
  CHECK(device::fault_line(Fault::self_test_failed, test) == "self_test_failed: " + text.cause + " " + text.remedy);
  CHECK(device::fault_text(Fault::over_speed, test).cause == device::fault_text(Fault::over_speed).cause);
}
