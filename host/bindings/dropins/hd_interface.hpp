// The exported functions of libHD.so. docs/dropins.md describes them.
#pragma once

#include "host/bindings/dropins/constants.hpp"

#define INKWELL_HD __attribute__((visibility("default")))

extern "C" {
using HdBoolean = inkwell::dropins::Boolean;
using HdCallback = inkwell::dropins::Callback;
using HdEnum = inkwell::dropins::Enum;
using HdErrorInfo = inkwell::dropins::ErrorInfo;
using HdHandle = inkwell::dropins::Handle;
using HdTask = inkwell::dropins::TaskHandle;

INKWELL_HD HdHandle hdInitDevice(const char* name);
INKWELL_HD void hdDisableDevice(HdHandle device);
INKWELL_HD void hdMakeCurrentDevice(HdHandle device);
INKWELL_HD HdHandle hdGetCurrentDevice(void);
INKWELL_HD void hdBeginFrame(HdHandle device);
INKWELL_HD void hdEndFrame(HdHandle device);

INKWELL_HD void hdGetBooleanv(HdEnum parameter, HdBoolean* values);
INKWELL_HD void hdGetIntegerv(HdEnum parameter, int* values);
INKWELL_HD void hdGetFloatv(HdEnum parameter, float* values);
INKWELL_HD void hdGetDoublev(HdEnum parameter, double* values);
INKWELL_HD void hdGetLongv(HdEnum parameter, long* values);
INKWELL_HD const char* hdGetString(HdEnum parameter);
INKWELL_HD void hdSetBooleanv(HdEnum parameter, const HdBoolean* values);
INKWELL_HD void hdSetIntegerv(HdEnum parameter, const int* values);
INKWELL_HD void hdSetFloatv(HdEnum parameter, const float* values);
INKWELL_HD void hdSetDoublev(HdEnum parameter, const double* values);
INKWELL_HD void hdSetLongv(HdEnum parameter, const long* values);
INKWELL_HD void hdEnable(HdEnum capability);
INKWELL_HD void hdDisable(HdEnum capability);
INKWELL_HD HdBoolean hdIsEnabled(HdEnum capability);

INKWELL_HD HdErrorInfo hdGetError(void);
INKWELL_HD const char* hdGetErrorString(unsigned code);

INKWELL_HD void hdStartScheduler(void);
INKWELL_HD void hdStopScheduler(void);
INKWELL_HD void hdSetSchedulerRate(unsigned long rate_Hz);
INKWELL_HD HdTask hdScheduleAsynchronous(HdCallback callback, void* user, unsigned short priority);
INKWELL_HD void hdScheduleSynchronous(HdCallback callback, void* user, unsigned short priority);
INKWELL_HD void hdUnschedule(HdTask task);
INKWELL_HD HdBoolean hdWaitForCompletion(HdTask task, unsigned wait_code);
INKWELL_HD double hdGetSchedulerTimeStamp(void);

INKWELL_HD HdEnum hdCheckCalibration(void);
INKWELL_HD HdEnum hdCheckCalibrationStyle(void);
INKWELL_HD void hdUpdateCalibration(HdEnum style);
INKWELL_HD void hdUpdateCalibrationMessage(HdEnum style);

INKWELL_HD HdBoolean hdDeploymentLicense(const char* vendor, const char* application, const char* password);
INKWELL_HD HdBoolean hdScaleGimbalAngles(double x, double y, double z, double transform[16]);

/// Not part of HDAPI. libhdPhantom.so calls this function to remove the errors of its internal frames. Returns 1 if one
/// of the removed errors was a lost link.
INKWELL_HD HdBoolean hdInkwellForgetErrors(HdHandle device);
}
