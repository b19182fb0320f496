// HDAPI declarations for the tests, written from the published reference.
#pragma once

extern "C" {
typedef unsigned int HHD, HDenum, HDerror, HDCallbackCode;
typedef unsigned char HDboolean;
typedef unsigned long HDSchedulerHandle;
typedef HDCallbackCode (*HDSchedulerCallback)(void*);
struct HDErrorInfo {
  HDerror errorCode;
  int internalErrorCode;
  HHD hHD;
};

HHD hdInitDevice(const char*);
void hdDisableDevice(HHD);
void hdMakeCurrentDevice(HHD);
HHD hdGetCurrentDevice(void);
void hdBeginFrame(HHD);
void hdEndFrame(HHD);
void hdGetBooleanv(HDenum, HDboolean*);
void hdGetIntegerv(HDenum, int*);
void hdGetFloatv(HDenum, float*);
void hdGetDoublev(HDenum, double*);
void hdGetLongv(HDenum, long*);
const char* hdGetString(HDenum);
void hdSetIntegerv(HDenum, const int*);
void hdSetFloatv(HDenum, const float*);
void hdSetDoublev(HDenum, const double*);
void hdSetLongv(HDenum, const long*);
void hdEnable(HDenum);
void hdDisable(HDenum);
HDboolean hdIsEnabled(HDenum);
HDErrorInfo hdGetError(void);
const char* hdGetErrorString(HDerror);
void hdStartScheduler(void);
void hdStopScheduler(void);
void hdSetSchedulerRate(unsigned long);
HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback, void*, unsigned short);
void hdScheduleSynchronous(HDSchedulerCallback, void*, unsigned short);
void hdUnschedule(HDSchedulerHandle);
HDboolean hdWaitForCompletion(HDSchedulerHandle, unsigned int);
double hdGetSchedulerTimeStamp(void);
HDenum hdCheckCalibration(void);
HDenum hdCheckCalibrationStyle(void);
void hdUpdateCalibration(HDenum);
}

constexpr HHD HD_INVALID_HANDLE = 0xFFFFFFFF;
constexpr HDCallbackCode HD_CALLBACK_DONE = 0, HD_CALLBACK_CONTINUE = 1;
constexpr unsigned HD_WAIT_CHECK_STATUS = 0, HD_WAIT_INFINITE = 1;
constexpr unsigned short HD_DEFAULT_SCHEDULER_PRIORITY = 32767;
constexpr HDenum HD_CURRENT_BUTTONS = 0x2000, HD_LAST_BUTTONS = 0x2200, HD_CURRENT_INKWELL_SWITCH = 0x2002,
                 HD_CURRENT_POSITION = 0x2050, HD_LAST_POSITION = 0x2250, HD_CURRENT_VELOCITY = 0x2051,
                 HD_CURRENT_TRANSFORM = 0x2052, HD_CURRENT_JACOBIAN = 0x2054, HD_VERSION = 0x2500,
                 HD_DEVICE_SERIAL_NUMBER = 0x2504, HD_UPDATE_RATE = 0x2600, HD_INSTANTANEOUS_UPDATE_RATE = 0x2601,
                 HD_NOMINAL_MAX_FORCE = 0x2603, HD_FORCE_RAMPING_RATE = 0x2608, HD_CURRENT_FORCE = 0x2700,
                 HD_LAST_FORCE = 0x2800, HD_JOINT_ANGLE_REFERENCES = 0x2702, HD_CURRENT_JOINT_TORQUE = 0x2703,
                 HD_CURRENT_MOTOR_DAC_VALUES = 0x2750, HD_FORCE_OUTPUT = 0x4000, HD_MAX_FORCE_CLAMPING = 0x4001,
                 HD_ONE_FRAME_LIMIT = 0x4004;
constexpr HDenum HD_CURRENT_SAFETY_SWITCH = 0x2001, HD_SOFTWARE_VELOCITY_LIMIT = 0x2606;
constexpr HDenum HD_CALIBRATION_OK = 0x5000, HD_CALIBRATION_NEEDS_UPDATE = 0x5001,
                 HD_CALIBRATION_NEEDS_MANUAL_INPUT = 0x5002;
constexpr HDerror HD_SUCCESS = 0, HD_INVALID_ENUM = 0x100, HD_INVALID_VALUE = 0x101, HD_INVALID_OPERATION = 0x102,
                  HD_INVALID_INPUT_TYPE = 0x103, HD_BAD_HANDLE = 0x104, HD_EXCEEDED_MAX_VELOCITY = 0x203,
                  HD_FORCE_ERROR = 0x204, HD_DEVICE_FAULT = 0x300, HD_DEVICE_ALREADY_INITIATED = 0x301,
                  HD_COMM_ERROR = 0x302, HD_ILLEGAL_BEGIN = 0x400, HD_ILLEGAL_END = 0x401, HD_FRAME_ERROR = 0x402;
