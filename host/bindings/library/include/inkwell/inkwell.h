/* libinkwell: C library for programs that use a haptic arm.
 *
 *   inkwell_arm* arm = NULL;
 *   if (inkwell_open(NULL, &arm) != INKWELL_OK) { puts(inkwell_error_text()); return 1; }
 *   inkwell_enable_force(arm, 5.0);
 *   inkwell_start_servo(arm, my_servo, NULL);       // called at each pose, 1000 times per second
 *   ...
 *   inkwell_close(arm);
 *
 * Lengths are in meters, forces in newtons, angles in radians, times in seconds. Positions and forces are in the arm's
 * workspace axes. On the Omni x points to the right, y up, z to the user.
 *
 * Every function may be called from any thread, but inkwell_close() must be the last call for its arm. No function
 * throws or aborts. Each function returns a result, and inkwell_error_text() returns the error as a sentence.
 *
 * A forked child cannot use an arm that its parent has opened. In the child, inkwell_close() does nothing, and every
 * other function returns INKWELL_REFUSED. A canceled thread stops where it waits for a pose, samples, the force or the
 * end of a servo, otherwise after the call. */
#ifndef INKWELL_INKWELL_H
#define INKWELL_INKWELL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define INKWELL_API __attribute__((visibility("default")))

/* C may pass any int, so C++ must not assume a narrower enumeration. */
#ifdef __cplusplus
#define INKWELL_AS_INT : int
#else
#define INKWELL_AS_INT
#endif

/* Result of a function. */
typedef enum inkwell_result INKWELL_AS_INT {
  INKWELL_OK = 0,
  INKWELL_NO_DEVICE = 1,     /* no arm is connected, or the address does not select one of several */
  INKWELL_NO_PERMISSION = 2, /* the user has no permission to open the device */
  INKWELL_INCOMPATIBLE = 3,  /* the firmware belongs to another version of this library */
  INKWELL_DISCONNECTED = 4,  /* no poses arrive: the link is lost, or the device is silent; see below */
  INKWELL_IN_USE = 5,        /* another program has exclusive use of the arm or the scope */
  INKWELL_BAD_ARGUMENT = 6,  /* the function does not accept a value */
  INKWELL_REFUSED = 7,       /* the device does not accept the request in its present state */
  INKWELL_TIMED_OUT = 8,     /* the expected event did not occur in time */
  INKWELL_FAILED = 9,        /* any other error; the sentence describes it */
  INKWELL_FORCE_LOST = 10    /* the force went off without a call of this program */
} inkwell_result;

/* The library recovers from INKWELL_DISCONNECTED by itself. After an unplugged cable or a restart of the board it
 * searches for the same arm five times per second and opens it again. A device that was silent for 2 s is connected
 * again with its next pose. Until then no force is sent, and functions that return a pose write the last known pose.
 * After the recovery:
 *   - the force is off until inkwell_enable_force() is called again, except after a silence;
 *   - a servo has stopped, and inkwell_servo_result() returns the cause;
 *   - signals must be selected again, except after a silence;
 *   - a board that has restarted has its stored parameters.
 * A virtual board that inkwell_open() has started does not return after it has exited. */

/* Version of this header. A program can compare it: #if INKWELL_VERSION_NUMBER >= 200 means 0.2.0 or newer. */
#define INKWELL_VERSION_MAJOR 0
#define INKWELL_VERSION_MINOR 2
#define INKWELL_VERSION_PATCH 0
#define INKWELL_VERSION_NUMBER \
  (INKWELL_VERSION_MAJOR * 10000 + INKWELL_VERSION_MINOR * 100 + INKWELL_VERSION_PATCH)

/* Version of the loaded library, for example "0.2.0". */
INKWELL_API const char* inkwell_version(void);

/* The last error in the calling thread and its remedy as a sentence; empty if there was no error. A successful call
 * leaves the text unchanged, as with errno. The next error of the thread overwrites it. */
INKWELL_API const char* inkwell_error_text(void);

/* ---- devices ------------------------------------------------------------------------------------------------ */

/* An arm that can be opened. */
typedef struct inkwell_device {
  char address[128];      /* for inkwell_open() */
  char serial_number[32]; /* empty if it is not known before the device is opened */
  char product[64];
  int is_virtual; /* 1 for a simulation */
} inkwell_device;

/* Lists the arms on this computer's USB, and the virtual boards that answer and that have a name or are in
 * INKWELL_DEVICE. Arms with a name come first, in the order of their names; the arm of INKWELL_DEVICE comes last if it
 * is virtual and has no name. Writes at most `capacity` arms, and their total number to `count`. */
INKWELL_API inkwell_result inkwell_list_devices(inkwell_device* devices, size_t capacity, size_t* count);

/* Waits until an arm is plugged in or removed. `devices` and `count` contain the known list, from this function or from
 * inkwell_list_devices(); at first `count` may be 0. Writes the new list as inkwell_list_devices() does. If the list
 * does not change within `timeout_s` of the host's clock, it returns INKWELL_TIMED_OUT. */
INKWELL_API inkwell_result inkwell_wait_for_devices(double timeout_s, inkwell_device* devices, size_t capacity,
                                                    size_t* count);

/* A name, such as "left", that the user has bound to an arm with `inkwell arms bind`. */
typedef struct inkwell_named_arm {
  char name[64];
  char address[128]; /* serial number, or another address for inkwell_open() */
} inkwell_named_arm;

/* Lists the names of arms in the order of the file inkwell/arms.toml in $XDG_CONFIG_HOME (~/.config), or of the file in
 * the environment variable INKWELL_ARMS. The arms need not be connected. Writes at most `capacity` names, and their total
 * number to `count`. A damaged file is an error. */
INKWELL_API inkwell_result inkwell_list_names(inkwell_named_arm* names, size_t capacity, size_t* count);

/* An open arm. */
typedef struct inkwell_arm inkwell_arm;

/* Kind of an address. */
typedef enum inkwell_address_kind INKWELL_AS_INT {
  INKWELL_ON_USB = 0,    /* any other text: a serial number, or a name, which may also belong to a virtual board */
  INKWELL_AT_SERVER = 1, /* "usbip:HOST:PORT" or "usbip:unix:PATH" */
  INKWELL_OWN_BOARD = 2  /* "virtual" or "virtual:FILE": each call starts a separate board */
} inkwell_address_kind;

/* Returns the kind of address that inkwell_open() recognizes in the text, without connecting to it. */
INKWELL_API inkwell_result inkwell_kind_of_address(const char* address, inkwell_address_kind* kind);

/* Opens an arm. `address`:
 *   NULL or ""         the address in the environment variable INKWELL_DEVICE, otherwise the only arm on USB
 *   a serial number    the arm on USB with this number
 *   a name             the arm with this name; see inkwell_list_names(). Upper and lower case are equal
 *   "usbip:HOST:PORT"  the arm of a USB/IP server, such as a running virtual board; "usbip:unix:PATH" for a
 *                      Unix socket
 *   "virtual"          a new virtual board, which is ready and exits with inkwell_close(); "virtual:FILE" with
 *                      the arm description FILE
 * The force is off. The function returns after the first pose. It waits up to 60 s for this pose, and then returns
 * INKWELL_TIMED_OUT. */
INKWELL_API inkwell_result inkwell_open(const char* address, inkwell_arm** arm);

/* Does the same as inkwell_open(), but waits at most `timeout_s` of the host's clock. A computer that does not answer can
 * delay the result by a further 10 s. */
INKWELL_API inkwell_result inkwell_open_with_timeout(const char* address, double timeout_s, inkwell_arm** arm);

/* Fades this program's force, stops the servo and closes the arm. NULL is allowed. The function waits until a running
 * call of the servo returns, without a time limit; the servo's force has faded by then. In the servo itself the
 * function returns INKWELL_REFUSED, and the arm stays open. */
INKWELL_API inkwell_result inkwell_close(inkwell_arm* arm);

/* Identity and counters of the device. */
typedef struct inkwell_information {
  char serial_number[32];
  char product[64];
  char firmware_version[16];
  int is_virtual;
  double servo_rate_Hz;          /* rate of the board's control interrupt */
  uint32_t servo_cycles_longest; /* longest control interrupt since the board started, processor cycles */
  uint32_t force_reports;        /* forces received from programs since the board started; this counter and
                                    the next three wrap after 49 days at one force per millisecond */
  uint32_t force_reports_lost;
  uint32_t force_reports_late;
  uint32_t force_reports_refused;
  double motor_heat[3]; /* 1 is the heat at continuous current; see INKWELL_MOTOR_HEAT_HOLDS_BACK */
} inkwell_information;

/* Above this heat a motor's current, and with it the force, may be reduced. */
#define INKWELL_MOTOR_HEAT_HOLDS_BACK 0.85f

/* Reads the value from the device. */
INKWELL_API inkwell_result inkwell_get_information(inkwell_arm* arm, inkwell_information* information);

/* Size of a board's name in characters, including the terminating zero. */
#define INKWELL_BOARD_NAME_SIZE 32

/* Returns the board that the device's firmware was built for, such as "omni_driver"; empty if the firmware does not
 * report it. A name that is unknown to this library is not an error. */
INKWELL_API inkwell_result inkwell_get_board_name(inkwell_arm* arm, char name[INKWELL_BOARD_NAME_SIZE]);

/* ---- pose --------------------------------------------------------------------------------------------------- */

/* State of the board. */
typedef enum inkwell_state INKWELL_AS_INT {
  INKWELL_STARTING = 0,
  INKWELL_UNREFERENCED = 1, /* the stylus must rest in the inkwell once */
  INKWELL_READY = 2,        /* the pose is valid, the force is off */
  INKWELL_ACTIVE = 3,       /* the pose is valid, the force is on */
  INKWELL_FAULT = 4         /* the force is off, and inkwell_fault_text() returns the cause;
                               inkwell_is_referenced() returns whether the pose is valid */
} inkwell_state;

/* Cause of INKWELL_FAULT. Newer firmware may report a code that is not in this list. */
typedef enum inkwell_fault INKWELL_AS_INT {
  INKWELL_FAULT_NONE = 0,
  INKWELL_FAULT_BRIDGE_FAULT = 1,
  INKWELL_FAULT_SUPPLY_LOW = 2,
  INKWELL_FAULT_SUPPLY_HIGH = 3,
  INKWELL_FAULT_CURRENT_SENSOR = 4,
  INKWELL_FAULT_OVER_CURRENT = 5,
  INKWELL_FAULT_OVER_SPEED = 6,
  INKWELL_FAULT_ENCODER_IMPLAUSIBLE = 7,
  INKWELL_FAULT_HOST_SILENT = 8,
  INKWELL_FAULT_SERVO_OVERRUN = 9,
  INKWELL_FAULT_WATCHDOG = 10,
  INKWELL_FAULT_PROCESSOR_FAULT = 11,
  INKWELL_FAULT_NOT_FINITE = 12,
  INKWELL_FAULT_SAMPLES_STALE = 13,
  INKWELL_FAULT_CRYSTAL_FAILED = 14,
  INKWELL_FAULT_FORCE_LAW = 15,
  INKWELL_FAULT_MOTOR_HOT = 16,
  INKWELL_FAULT_MEMORY_DAMAGED = 17,
  INKWELL_FAULT_MOTOR_IMPLAUSIBLE = 18,
  INKWELL_FAULT_LOGIC_SUPPLY_LOW = 19,
  INKWELL_FAULT_SUPPLY_RIPPLE = 20,
  INKWELL_FAULT_ENCODER_WIRE = 21,
  INKWELL_FAULT_BRIDGE_WIRE = 22,
  INKWELL_FAULT_ANALOG_SUPPLY = 23,
  INKWELL_FAULT_SELF_TEST_FAILED = 24,
  INKWELL_FAULT_INKWELL_IMPLAUSIBLE = 25,
  INKWELL_FAULT_MAIN_LOOP_STALLED = 26,
  INKWELL_FAULT_HEARTBEAT_MISSED = 27,
  INKWELL_FAULT_CURRENT_JUMP = 28,
  INKWELL_FAULT_USB_GONE = 29
} inkwell_fault;

/* Sources of the force on the hand: bits of inkwell_pose::force_sources. No bit is set while the force is off. */
enum inkwell_force_source {
  INKWELL_WALLS = 1,  /* the walls of the board's box */
  INKWELL_SHAPES = 2, /* planes or a sphere that a program placed */
  INKWELL_PROGRAM = 4 /* forces of a program */
};

/* Limits that reduce the force at present: bits of inkwell_pose::limits. A limit is not a fault. The driving component
 * is the force component along the motion. */
enum inkwell_limit {
  INKWELL_LIMIT_FORCE = 1,   /* the force is limited to force_limit_N, or is rising to it */
  INKWELL_LIMIT_CURRENT = 2, /* a motor is at its current limit; all motors are scaled down together */
  INKWELL_LIMIT_CHANGE = 4,  /* the force changes at the rate force_change_N_per_s */
  INKWELL_LIMIT_ENERGY = 8,  /* the energy reserve is used up; the driving component is scaled down */
  INKWELL_LIMIT_HEAT = 16,   /* a hot motor is at its reduced current limit; all motors are scaled down together */
  INKWELL_LIMIT_MOTORS = 64, /* a motor is missing or unknown, so no motor receives current for the force */
  INKWELL_LIMIT_SPEED = 32   /* the probe is close to the speed limit; the driving component is scaled down */
};

/* Report of the board in one bus frame (1 ms). */
typedef struct inkwell_pose {
  double time_s;     /* board time; it does not wrap while the arm is open */
  uint32_t sequence; /* counts the bus frames; a gap is a pose that this program missed. It wraps after 49 days, so
                        compare 32-bit differences */
  inkwell_state state;
  int fault;              /* one of inkwell_fault */
  uint32_t limits;        /* bits of inkwell_limit */
  double position_m[3];   /* of the probe, the point where the gimbal axes meet */
  double velocity_m_s[3]; /* mean over the last 8 ms */
  double rotation[9];     /* of the stylus, row by row; columns are its x, y and z axes; z points away from its tip */
  double gimbal_rad[3];   /* yaw, pitch, roll */
  double joint_rad[3];    /* see inkwell_forward_kinematics() */
  double force_N[3];      /* total force that the board requests from the motors */
  uint32_t force_sources; /* bits of inkwell_force_source */
  int button_1, button_2; /* 1 while pressed */
  int in_inkwell;         /* 1 while the stylus rests in the inkwell */
  double supply_V;
} inkwell_pose;

/* Returns the newest pose without waiting. With INKWELL_DISCONNECTED `pose` is the last known pose. */
INKWELL_API inkwell_result inkwell_get_pose(inkwell_arm* arm, inkwell_pose* pose);

/* Waits for the next pose that this thread has not read. With INKWELL_TIMED_OUT and INKWELL_DISCONNECTED `pose` is the
 * last known pose. After a lost link the function returns INKWELL_DISCONNECTED without waiting. It waits for a silent
 * device. */
INKWELL_API inkwell_result inkwell_wait_for_pose(inkwell_arm* arm, double timeout_s, inkwell_pose* pose);

/* Waits until this board time has passed. A virtual board's time follows the program, not the PC's clock. Returns
 * INKWELL_TIMED_OUT if no pose arrives for 2 s. */
INKWELL_API inkwell_result inkwell_sleep(inkwell_arm* arm, double duration_s);

/* Writes 1 while the encoders are referenced, otherwise 0. They are referenced after the stylus has rested in the
 * inkwell, until encoder counts may have been lost. Otherwise the newest pose has no valid position, joints or
 * rotation, and its velocity is 0. */
INKWELL_API inkwell_result inkwell_is_referenced(inkwell_arm* arm, int* is_referenced);

/* Computes the probe's position and Jacobian for these joint angles. `jacobian` is in m/rad and in row-major order. The
 * Jacobian times the joint speeds is the probe's velocity. The transposed Jacobian times a force is the joint torques.
 * Either output may be NULL.
 *
 * On the Omni, joint 1 turns both links about the vertical axis. At 0 they point to the user, and it is positive to the
 * left. Joint 2 is the elevation of link 2. At 0 link 2 is horizontal, and it is positive upward. Joint 3 is the
 * direction of link 3, measured from the base. At 0 link 3 points straight down, and it is positive toward the user and
 * upward. The angle of link 3 relative to link 2 is therefore joint 3 minus joint 2. */
INKWELL_API inkwell_result inkwell_forward_kinematics(inkwell_arm* arm, const double joint_rad[3], double position_m[3],
                                                      double jacobian[9]);

/* Pose of one bus frame with its validity, speeds and times. A later library may append members. */
typedef struct inkwell_arm_state {
  inkwell_pose pose;
  int is_referenced;             /* 1: position, joints and rotation of `pose` are valid; see inkwell_is_referenced() */
  int64_t received_ns;           /* host time of the pose's arrival, ns since 1970 (CLOCK_REALTIME) */
  int64_t received_monotonic_ns; /* the same in CLOCK_MONOTONIC, which clock changes do not affect */
  double quaternion[4];          /* rotation of the stylus as x, y, z, w, with w >= 0 */
  double angular_velocity_rad_per_s[3]; /* of the stylus, in workspace axes; mean over the last 8 ms */
  double joint_speed_rad_per_s[3];      /* mean over the last 8 ms */
  double joint_torque_Nm[3];            /* that force_N of the pose requires */
} inkwell_arm_state;

/* Returns the newest state without waiting. `size` is sizeof(inkwell_arm_state), so that later libraries can append
 * members. With INKWELL_DISCONNECTED `state` is the last known state. While no poses arrive, this function,
 * inkwell_get_pose() and inkwell_set_force() allocate no memory. */
INKWELL_API inkwell_result inkwell_get_state(inkwell_arm* arm, inkwell_arm_state* state, size_t size);

/* Capabilities of an arm, from its parameters. A later library may append members. */
typedef struct inkwell_abilities {
  double workspace_minimum_m[3], workspace_maximum_m[3]; /* box of the arm */
  double workspace_radius_m;                             /* of the largest sphere in the box */
  double reach_minimum_m[3], reach_maximum_m[3];         /* range of the probe within the joint stops */
  double joint_minimum_rad[3], joint_maximum_rad[3];     /* joint stops; the third is that of link 3 relative to link 2 */
  int third_joint_is_absolute;                           /* 1: joint 3 is measured from the base, as on the Omni */
  double force_N;                                        /* largest force, force_limit_N */
  double continuous_force_N;                             /* every motor tolerates it continuously, in every pose */
  double joint_torque_Nm[3];                             /* at the current limits of the motors */
  double continuous_joint_torque_Nm[3];
  double stiffness_N_per_m, damping_Ns_per_m; /* recommended maxima for forces of a program at 1000 Hz */
  double pose_rate_Hz;
} inkwell_abilities;

/* Reads the value from the device. `size` is sizeof(inkwell_abilities). */
INKWELL_API inkwell_result inkwell_get_abilities(inkwell_arm* arm, inkwell_abilities* abilities, size_t size);

/* Computes the force at the probe that requires these torques at these joint angles. Returns INKWELL_REFUSED and the
 * force 0 if the arm is stretched or folded, because no force has these torques. */
INKWELL_API inkwell_result inkwell_force_of_torques(inkwell_arm* arm, const double joint_rad[3],
                                                    const double torque_Nm[3], double force_N[3]);

/* Cause and remedy of a fault code; never NULL. */
INKWELL_API const char* inkwell_fault_text(int fault);
/* Name of a fault code, such as "over_speed" for INKWELL_FAULT_OVER_SPEED; NULL for a code without a name. */
INKWELL_API const char* inkwell_fault_name(int fault);

/* ---- force -------------------------------------------------------------------------------------------------- */

/* One program drives an arm at a time, and the board decides which program. A program claims the arm with
 * inkwell_claim(), or with its first call of inkwell_enable_force(), inkwell_set_force(), inkwell_start_servo() or
 * inkwell_place_*(). The claim lasts until inkwell_release() or inkwell_close(). If the program exits without this call, the board ends the claim after one second. While a
 * program drives the arm, these functions, inkwell_disable_force(), inkwell_clear_fault() and parameter changes return
 * INKWELL_IN_USE in every other program. inkwell_error_text() then names the driver. Any program may read, record and
 * call inkwell_stop(). */

/* Switches the force on. After this call the hand may feel a force. Waits until the device is active, for at most
 * `timeout_s` of board time or 2 s of silence. Returns INKWELL_REFUSED in a fault, or if the stylus was not in the
 * inkwell yet. The faults "usb_gone" and "host_silent" of a previous driver, or from before a lost link, are cleared
 * first. */
INKWELL_API inkwell_result inkwell_enable_force(inkwell_arm* arm, double timeout_s);
/* Reduces the force to zero within the parameter soft_landing_s, and returns when the force is off. */
INKWELL_API inkwell_result inkwell_disable_force(inkwell_arm* arm);
/* Switches the force off immediately, whichever program drives the arm, and returns when the force is off. */
INKWELL_API inkwell_result inkwell_stop(inkwell_arm* arm);

/* Claims the arm without a force. A control loop whose later calls must not wait calls this function first. */
INKWELL_API inkwell_result inkwell_claim(inkwell_arm* arm);
/* Reduces the force to zero, removes the shapes and ends the claim. The arm stays open. Returns INKWELL_REFUSED while a
 * servo is running. Has no effect without a claim. */
INKWELL_API inkwell_result inkwell_release(inkwell_arm* arm);

/* Takes the arm over from its current driver. The driver's force fades, and its shapes are removed. */
INKWELL_API inkwell_result inkwell_take_over(inkwell_arm* arm);

/* The program that drives the arm. */
typedef struct inkwell_driver {
  int is_driven;       /* 0: no program drives the arm, and the other fields are 0 */
  int is_this_arm;     /* 1: the arm is driven through this arm object */
  uint32_t process_id; /* process number on the driver's computer */
  char program[32];    /* printable ASCII */
  double driven_s;     /* board time since it claimed the arm */
} inkwell_driver;

/* Reads the value from the device. */
INKWELL_API inkwell_result inkwell_get_driver(inkwell_arm* arm, inkwell_driver* driver);
/* Clears a fault whose cause is gone, and waits 0.2 s to confirm that the fault does not recur. If the board repeats
 * its self-test, the function waits for the end of the test. If the cause is still present, the function returns
 * INKWELL_REFUSED, and the sentence names the fault and its remedy. Without a fault the function
 * returns immediately. */
INKWELL_API inkwell_result inkwell_clear_fault(inkwell_arm* arm);

/* Effect of a program's forces on the walls. */
typedef enum inkwell_force_mode INKWELL_AS_INT {
  INKWELL_BESIDE_WALLS = 1,    /* the walls of the board's box are active too */
  INKWELL_INSTEAD_OF_WALLS = 2 /* only the forces of programs are active */
} inkwell_force_mode;

/* Sets how this program's forces combine with the board's walls. The default is INKWELL_INSTEAD_OF_WALLS. */
INKWELL_API inkwell_result inkwell_set_force_mode(inkwell_arm* arm, inkwell_force_mode mode);

/* Sets the force on the hand until the next call. The force is sent within a millisecond, at most once per millisecond.
 * The board changes the force linearly, up to its force limit. Without another call the force fades after
 * program_force_expiry_s. A value that is infinite or not a number returns INKWELL_BAD_ARGUMENT, and the previous force
 * stays. While another program drives the arm, the function returns INKWELL_IN_USE. After a fault, another program or a
 * lost link has switched the force off, it returns INKWELL_FORCE_LOST. This result lasts until the force is on again,
 * or until this program calls a function that switches the force. In the servo, return the force instead. */
INKWELL_API inkwell_result inkwell_set_force(inkwell_arm* arm, const double force_N[3]);

/* Sets the force that requires these joint torques at the newest pose, as inkwell_set_force() does. Returns
 * INKWELL_REFUSED and sets the force 0 if the arm is stretched or folded. */
INKWELL_API inkwell_result inkwell_set_joint_torques(inkwell_arm* arm, const double torque_Nm[3]);

/* Schedules this arm's threads, which read poses, send forces and call the servo, with SCHED_FIFO and this priority, 1
 * to 99. 0 selects normal scheduling. Returns INKWELL_NO_PERMISSION if the user may not set real-time priorities. The
 * mutexes of poses and forces inherit the priority of waiting threads. */
INKWELL_API inkwell_result inkwell_set_thread_priority(inkwell_arm* arm, int priority);

/* Function that the library calls at each pose, 1000 times per second, in a thread of the library. The function writes
 * the force on the hand, which is preset to 0. A component that is infinite or not a number counts as 0. The function
 * returns 0 to continue and any other value to stop the servo. See inkwell_servo_result() for other causes that stop
 * it. The time of a virtual board waits until the function returns, so no pose is missed. */
typedef int (*inkwell_servo)(inkwell_arm* arm, const inkwell_pose* pose, double force_N[3], void* user);
/* Starts to call `servo` with the argument `user`. */
INKWELL_API inkwell_result inkwell_start_servo(inkwell_arm* arm, inkwell_servo servo, void* user);
/* Stops the servo and waits until its last call has returned. In the servo itself it does not wait. */
INKWELL_API inkwell_result inkwell_stop_servo(inkwell_arm* arm);
/* 1 while the servo is being called. */
INKWELL_API int inkwell_servo_is_running(inkwell_arm* arm);
/* Returns why the last servo has stopped; inkwell_error_text() then returns the sentence. INKWELL_FORCE_LOST: a fault
 * or another program switched the force off. INKWELL_DISCONNECTED: the link was lost, or the device was silent.
 * INKWELL_IN_USE: another program drives the arm. INKWELL_OK: the program stopped the servo, the servo is running, or
 * there was no servo. */
INKWELL_API inkwell_result inkwell_servo_result(inkwell_arm* arm);

/* ---- shapes ------------------------------------------------------------------------------------------------- */

/* Largest number of planes that the board renders. */
#define INKWELL_PLANES_MAXIMUM 8

/* Surface properties of a shape. A shape with a life of 0 is not rendered. */
typedef struct inkwell_surface {
  double stiffness_N_per_m;
  double damping_Ns_per_m;
  double static_friction;  /* limit of the tangential force while the probe sticks, relative to the normal force */
  double dynamic_friction; /* the same while the probe slides; at most static_friction */
  /* The board removes the shape after this time, at most 10 s, unless it is placed again. INFINITY: the shape lasts as
   * long as the program drives the arm. */
  double life_s;
} inkwell_surface;

/* A plane. The probe stays on one side of the plane. */
typedef struct inkwell_plane {
  double point_m[3];
  double normal[3]; /* into the free space, of any length except 0 */
  inkwell_surface surface;
} inkwell_plane;

/* A sphere. The probe stays outside the sphere. */
typedef struct inkwell_sphere {
  double centre_m[3];
  double radius_m; /* the free space is outside */
  inkwell_surface surface;
} inkwell_sphere;

/* Replaces all shapes in one control period, without a jump of the force. The board renders the shapes at its full rate
 * and treats the probe as a point. `sphere` may be NULL, `plane_count` may be 0. */
INKWELL_API inkwell_result inkwell_place_shapes(inkwell_arm* arm, const inkwell_plane* planes, size_t plane_count,
                                                const inkwell_sphere* sphere);

/* Kind of a solid or object. Its frame has the origin in the center. */
typedef enum inkwell_shape INKWELL_AS_INT {
  INKWELL_SHAPE_SPHERE = 0,    /* size: radius */
  INKWELL_SHAPE_CAPSULE = 1,   /* size: radius, half length of the axis without the caps; along z */
  INKWELL_SHAPE_CYLINDER = 2,  /* size: radius, half length; along z */
  INKWELL_SHAPE_BOX = 3,       /* size: half lengths along x, y and z */
  INKWELL_SHAPE_MESH = 4,      /* only in a scene: triangles */
  INKWELL_SHAPE_HALF_SPACE = 5 /* only in a scene: all points with z below 0 */
} inkwell_shape;

/* Largest number of solids that the board renders. */
#define INKWELL_SOLIDS_MAXIMUM 16

/* A solid. The probe, which is a point, stays outside. A later library may append members. */
typedef struct inkwell_solid {
  inkwell_shape shape;
  double centre_m[3];
  double quaternion[4]; /* from the frame of the solid into the workspace: x, y, z, w. All 0: not turned */
  double size_m[3];     /* see inkwell_shape */
  inkwell_surface surface;
  double viscosity_Ns_per_m; /* tangential force per sliding speed; the force is at most the normal force */
} inkwell_solid;

/* Shapes for inkwell_place_all_shapes(). A later library may append members. */
typedef struct inkwell_shapes {
  const inkwell_plane* planes; /* may be NULL if plane_count is 0 */
  size_t plane_count;
  const double* plane_viscosity_Ns_per_m; /* one value for each plane; NULL: 0 */
  const inkwell_solid* solids;            /* may be NULL if solid_count is 0 */
  size_t solid_count;
  size_t solid_size; /* sizeof(inkwell_solid) */
} inkwell_shapes;

/* Does the same as inkwell_place_shapes(), with solids and viscosity. `size` is sizeof(inkwell_shapes). */
INKWELL_API inkwell_result inkwell_place_all_shapes(inkwell_arm* arm, const inkwell_shapes* shapes, size_t size);

/* ---- scene -------------------------------------------------------------------------------------------------- */

/* A scene contains objects that the hand feels while this program drives the arm and the force is on. At each pose, the
 * library computes a contact step in its thread and sends the surfaces near the tip to the board, which renders them at
 * its full rate. The tip is a sphere with the radius sphere_radius_m, at least 0.5 mm. The objects act in addition to
 * forces, shapes and walls.
 *
 * A function that changes the scene does not wait for the servo, and the next contact step uses the whole change. After
 * an error the scene is unchanged. If the function changes materials, it waits for the device. A tip inside an object
 * does not feel the object until the tip has left it. The scene lasts until the arm is closed, also without a claim. */

/* Largest numbers of objects and of different materials in a scene. */
#define INKWELL_OBJECTS_MAXIMUM 64
#define INKWELL_MATERIALS_MAXIMUM 16

/* Properties of a surface. */
typedef struct inkwell_material {
  double stiffness_N_per_m; /* at most 3000; 0 selects the default, 500 */
  double damping_Ns_per_m;
  double static_friction;    /* limit of the tangential force while the tip sticks, relative to the normal force */
  double dynamic_friction;   /* the same while the tip slides; at most static_friction */
  double viscosity_Ns_per_m; /* tangential force per sliding speed; the force is at most the normal force */
} inkwell_material;

/* Returns the material with this name: wood, rubber, glass, steel, stone, ice, skin, sponge or smooth. */
INKWELL_API inkwell_result inkwell_find_material(const char* name, inkwell_material* material);

/* Placement and motion of an object. The placement applies when the scene changes. From then on, the object moves with
 * its velocities for at most 20 ms of board time, and then stops. A program that moves an object sends each frame both
 * the placement and the velocities. */
typedef struct inkwell_placement {
  double position_m[3];             /* of the origin of the object's frame */
  double quaternion[4];             /* from the frame of the object into the workspace: x, y, z, w. All 0: not turned */
  double velocity_m_per_s[3];       /* of the origin */
  double angular_velocity_rad_per_s[3]; /* about the origin, in workspace axes */
} inkwell_placement;

/* Type of the numbers in an array. */
typedef enum inkwell_number INKWELL_AS_INT {
  INKWELL_FLOAT32 = 0,
  INKWELL_FLOAT64 = 1,
  INKWELL_INT32 = 2,
  INKWELL_UINT32 = 3,
  INKWELL_INT64 = 4,
  INKWELL_UINT64 = 5
} inkwell_number;

/* Triangles in arrays. The library copies the arrays. */
typedef struct inkwell_mesh {
  const void* vertices_m;     /* x, y and z of each vertex, at most 10 m from the origin */
  inkwell_number vertex_type; /* INKWELL_FLOAT32 or INKWELL_FLOAT64 */
  size_t vertex_count;
  const void* triangles;        /* indices of the corners of each triangle, counter-clockwise as seen from outside */
  inkwell_number triangle_type; /* one of the integer types */
  size_t triangle_count;
} inkwell_mesh;

/* An object. Members that are not used may be 0. A later library may append members. */
typedef struct inkwell_object {
  inkwell_shape shape;
  double size_m[3];  /* see inkwell_shape; not used by a mesh and a half-space */
  inkwell_mesh mesh; /* only of a mesh */
  inkwell_placement placement;
  inkwell_material material;
  int is_smooth; /* 1: normals of a mesh are interpolated, which hides facets. A smoothed surface can supply energy */
} inkwell_object;

/* Adds an object and writes its number, which is never 0 and is not used again. `size` is sizeof(inkwell_object). The
 * calling thread prepares a mesh, which lasts a few seconds for a million triangles. Duplicate triangles and triangles
 * without area are ignored, and a mesh that is inside out is turned. An open mesh is a surface with two sides. */
INKWELL_API inkwell_result inkwell_scene_add(inkwell_arm* arm, const inkwell_object* object, size_t size,
                                             uint32_t* number);
/* Moves an object. It pushes the tip on a straight path from its previous placement. */
INKWELL_API inkwell_result inkwell_scene_move(inkwell_arm* arm, uint32_t number, const inkwell_placement* placement);
INKWELL_API inkwell_result inkwell_scene_set_material(inkwell_arm* arm, uint32_t number,
                                                      const inkwell_material* material);
INKWELL_API inkwell_result inkwell_scene_remove(inkwell_arm* arm, uint32_t number);
/* Removes all objects. */
INKWELL_API inkwell_result inkwell_scene_clear(inkwell_arm* arm);

/* A part of an object that the tip touches. A later library may append members. */
typedef struct inkwell_contact {
  uint32_t object;   /* number of the object */
  uint32_t triangle; /* index in inkwell_mesh::triangles; 0 for other shapes */
  double point_m[3]; /* on the surface, in the workspace */
  double normal[3];  /* unit vector from the surface to the tip */
  double depth_m;    /* of the hand below the surface, along the normal */
  double time_s;     /* board time */
} inkwell_contact;

/* Largest number of contacts at a time. */
#define INKWELL_CONTACTS_MAXIMUM 3

/* Writes at most `capacity` present contacts, and their total number to `count`. `size` is sizeof(inkwell_contact). */
INKWELL_API inkwell_result inkwell_scene_get_contacts(inkwell_arm* arm, inkwell_contact* contacts, size_t size,
                                                      size_t capacity, size_t* count);

/* Kind of an event. */
typedef enum inkwell_event_kind INKWELL_AS_INT {
  INKWELL_TOUCHED = 0, /* the tip touches an object */
  INKWELL_LEFT = 1,    /* the tip has not touched the object for 5 ms */
  INKWELL_PRESSED = 2, /* of a button */
  INKWELL_RELEASED = 3 /* of a button */
} inkwell_event_kind;

/* An event of the scene. A later library may append members. */
typedef struct inkwell_event {
  inkwell_event_kind kind;
  int button;              /* 1 or 2 for INKWELL_PRESSED and INKWELL_RELEASED, otherwise 0 */
  double time_s;           /* board time */
  inkwell_contact contact; /* the first of a touch, otherwise the last. `object` is 0 if the tip touches no object */
} inkwell_event;

/* Writes the oldest events, at most `capacity`, and their number to `count`, without waiting. `size` is
 * sizeof(inkwell_event). Events occur while this program drives the arm. The library stores 1024 events. `lost`, which
 * may be NULL, becomes the number of events that were lost since the last call. */
INKWELL_API inkwell_result inkwell_scene_read_events(inkwell_arm* arm, inkwell_event* events, size_t size,
                                                     size_t capacity, size_t* count, uint64_t* lost);

/* ---- parameters --------------------------------------------------------------------------------------------- */

/* A row of the parameter table. */
typedef struct inkwell_parameter {
  const char* name; /* ends in the unit */
  const char* unit; /* "" for a dimensionless number */
  const char* help;
  double minimum, maximum, default_value;
} inkwell_parameter;

/* Number of parameters, including the parameters of the force law once an arm is open. */
INKWELL_API size_t inkwell_parameter_count(void);
/* Row `index` of the table; NULL after the last row. */
INKWELL_API const inkwell_parameter* inkwell_parameter_at(size_t index);
/* Reads the value from the device. An unknown name returns INKWELL_BAD_ARGUMENT. */
INKWELL_API inkwell_result inkwell_get_parameter(inkwell_arm* arm, const char* name, double* value);
/* Sets parameters. All of them take effect in one control period, or none does. */
INKWELL_API inkwell_result inkwell_set_parameters(inkwell_arm* arm, const char* const* names, const double* values,
                                                  size_t count);

/* ---- stored parameters -------------------------------------------------------------------------------------- */

/* Parameter changes are lost when the board loses power, unless the parameters are stored. While the force is on or may
 * switch on immediately, the board refuses to store or erase. The result is then INKWELL_REFUSED, with the reason. */

/* Stores the current parameters on the board. They are in flash memory when the function returns. */
INKWELL_API inkwell_result inkwell_store_parameters(inkwell_arm* arm);
/* Sets every parameter to its stored value, in one transaction. Returns INKWELL_REFUSED if nothing is stored. */
INKWELL_API inkwell_result inkwell_restore_parameters(inkwell_arm* arm);
/* Erases the stored parameters, including the calibration of the arm, and sets every parameter to its default. */
INKWELL_API inkwell_result inkwell_factory_reset(inkwell_arm* arm);
/* Returns the value that this parameter has after the board's next start: the stored value or the default. */
INKWELL_API inkwell_result inkwell_get_stored_parameter(inkwell_arm* arm, const char* name, double* value);

/* Contents of the board's parameter store. */
typedef enum inkwell_stored INKWELL_AS_INT {
  INKWELL_STORED_NOTHING = 0,
  INKWELL_STORED_PARAMETERS = 1,
  INKWELL_STORED_FACTORY_RESET = 2, /* the stored parameters were erased */
  INKWELL_STORED_OTHER_SCHEMA = 3   /* records of another firmware, which this firmware cannot read */
} inkwell_stored;

/* State of the board's parameter store. */
typedef struct inkwell_store {
  inkwell_stored contents;
  uint32_t not_stored;       /* parameters that are lost at power loss */
  uint32_t stores_left;      /* stores that fit before the board's next start, which frees space */
  uint32_t records_written;  /* records since the board was made */
  uint32_t sector_erases[2]; /* erases of each of the two sectors since the board was made */
} inkwell_store;

/* Reads the value from the device. */
INKWELL_API inkwell_result inkwell_get_store(inkwell_arm* arm, inkwell_store* store);

/* ---- the board's self-test ------------------------------------------------------------------------------------- */

/* Result of a self-test item. */
typedef enum inkwell_test INKWELL_AS_INT {
  INKWELL_TEST_NOT_DONE = 0, /* not checked, or not checkable while another item fails */
  INKWELL_TEST_PASSED = 1,
  INKWELL_TEST_FAILED = 2,
  INKWELL_TEST_MOVED = 3,         /* not done: the arm moved too fast */
  INKWELL_TEST_NO_PART = 4,       /* not done: a motor with a current limit of 0 is not used */
  INKWELL_TEST_BROKEN_OFF = 5,    /* not done: no supply, or another fault interrupted the test */
  INKWELL_TEST_MISSING = 6,       /* a motor that is not connected; the motors receive no current for the force */
  INKWELL_TEST_UNKNOWN_MOTOR = 7, /* a motor of another resistance; the motors receive no current for the force */
  INKWELL_TEST_WRONG_SIGN = 8     /* the current has the wrong sign; this is a failure */
} inkwell_test;

/* An item of the self-test. The texts are valid until the process exits. */
typedef struct inkwell_test_item {
  const char* name;
  const char* meaning; /* condition that the test checks */
  const char* remedy;  /* what to do if the item fails */
  const char* unit;    /* unit of the figure; empty if the item has no figure */
  double figure;       /* 0 if the item has no figure, or was not checked */
  inkwell_test result;
  int takes_force; /* 1: a failure disables the force until a test passes */
} inkwell_test_item;

/* Runs the board's self-test, which lasts 50 ms and applies small pulses to the motors. Writes the first `capacity`
 * items, and the total number of items to `count`. Returns INKWELL_REFUSED while the force is on or the board reports
 * another fault. A failed item is not an error; its result shows the failure. */
INKWELL_API inkwell_result inkwell_self_test(inkwell_arm* arm, inkwell_test_item* items, size_t capacity,
                                             size_t* count);
/* Returns the results of the last test, which may be the test at the board's start, without a new test. */
INKWELL_API inkwell_result inkwell_get_self_test(inkwell_arm* arm, inkwell_test_item* items, size_t capacity,
                                                 size_t* count);

/* ---- the hand of a virtual board ------------------------------------------------------------------------------ */

/* The simulated hand lifts the stylus out of the inkwell and pulls the probe to `target_m` with a spring of
 * `stiffness_N_per_m`. The damping in Ns/m is a hundredth of the stiffness. This function and the next two require an
 * arm that was opened as "virtual", and return INKWELL_REFUSED on any other arm. */
INKWELL_API inkwell_result inkwell_move_virtual_hand(inkwell_arm* arm, const double target_m[3],
                                                     double stiffness_N_per_m);
/* The simulated hand releases the stylus, and the arm falls like a real arm. */
INKWELL_API inkwell_result inkwell_release_virtual_hand(inkwell_arm* arm);
/* The simulated hand presses (1) or releases (0) the buttons of the stylus. */
INKWELL_API inkwell_result inkwell_press_virtual_buttons(inkwell_arm* arm, int button_1, int button_2);

/* ---- scope and recording ------------------------------------------------------------------------------------ */

/* A row of the signal table. */
typedef struct inkwell_signal {
  const char* name; /* ends in the unit */
  const char* unit;
  const char* help;
} inkwell_signal;

/* Number of signals, including the signals of the force law once an arm is open. */
INKWELL_API size_t inkwell_signal_count(void);
/* Row `index` of the table; NULL after the last row. */
INKWELL_API const inkwell_signal* inkwell_signal_at(size_t index);

/* Starts to stream these signals at every control period; with no signals it stops the stream. Only one program can use
 * the scope, from its first selection until it selects no signals. Of more than 32 signals, those after the 32nd in the
 * order of the table are updated at 1250 Hz, and each signal must be given once. */
INKWELL_API inkwell_result inkwell_select_signals(inkwell_arm* arm, const char* const* names, size_t count);

/* Waits for samples, then writes at most `capacity` rows to `values`, with one value per selected signal in each row.
 * Writes the control periods of the rows to `periods`, which may be NULL, and the number of rows to `count`. Writes the
 * number of samples that were lost before the rows to `lost`, which may be NULL. A time-out returns INKWELL_OK and 0
 * rows. */
INKWELL_API inkwell_result inkwell_read_scope(inkwell_arm* arm, double timeout_s, float* values, uint32_t* periods,
                                              size_t capacity, size_t* count, uint64_t* lost);

/* Does the same as inkwell_read_scope(), with control periods that do not wrap. inkwell_read_scope() writes their lower
 * 32 bits, which wrap after 59 hours. A control period divided by servo_rate_Hz is a time on the time base of
 * inkwell_pose::time_s. */
INKWELL_API inkwell_result inkwell_read_samples(inkwell_arm* arm, double timeout_s, float* values, int64_t* periods,
                                                size_t capacity, size_t* count, uint64_t* lost);

/* Records the selected signals to a file until inkwell_stop_recording(). The extension selects HDF5 or CSV.
 * Marks state parameter changes, also those of other programs, except on a stepped board. */
INKWELL_API inkwell_result inkwell_start_recording(inkwell_arm* arm, const char* path);
/* Completes the file and returns its number of samples and of lost samples; both may be NULL. */
INKWELL_API inkwell_result inkwell_stop_recording(inkwell_arm* arm, uint64_t* samples, uint64_t* lost);

/* ---- the hand of a running virtual board ----------------------------------------------------------------------- */

/* Connects the simulated hand of a virtual board that was opened as "usbip:...". `control` is the address of the
 * board's control socket, "HOST:PORT" or "unix:PATH". The functions of the hand then work for this arm. */
INKWELL_API inkwell_result inkwell_connect_virtual_hand(inkwell_arm* arm, const char* control);
/* Does the same as inkwell_move_virtual_hand(), with a damping in Ns/m. */
INKWELL_API inkwell_result inkwell_hold_virtual_hand(inkwell_arm* arm, const double target_m[3],
                                                     double stiffness_N_per_m, double damping_Ns_per_m);

/* A point of a path of the hand. */
typedef struct inkwell_waypoint {
  double after_s; /* board time from the call on */
  double target_m[3];
} inkwell_waypoint;

/* Moves the target of a hand that holds the stylus through these points, smoothly and in rising order of time. */
INKWELL_API inkwell_result inkwell_move_virtual_hand_along(inkwell_arm* arm, const inkwell_waypoint* path,
                                                           size_t count);
/* Writes the true values of the simulation as JSON text of at most `capacity` bytes with its terminating zero, and the
 * size that the text needs to `size`. docs/virtual-board.md describes the values. */
INKWELL_API inkwell_result inkwell_read_virtual_truth(inkwell_arm* arm, char* json, size_t capacity, size_t* size);

/* ---- contents of a recording, losses, test pulses ------------------------------------------------------------- */

/* Sets name and note of the recordings that start later; NULL or "" for none. A recording also holds buttons, force
 * sources, shapes, faults, losses and parameter changes as events with board time, the time of the computer in
 * microseconds, and versions and hashes of the library, the image and the arm description. */
INKWELL_API inkwell_result inkwell_describe_recordings(inkwell_arm* arm, const char* name, const char* note);
/* Marks the newest pose in the running recording. The file holds the first 240 bytes of the text. Returns
 * INKWELL_REFUSED without a recording. */
INKWELL_API inkwell_result inkwell_mark(inkwell_arm* arm, const char* text);
/* Completes the file like inkwell_stop_recording(). Writes 1 to `is_complete` if nothing is missing: no sample was
 * lost, and the link was not lost. The pointers may be NULL. */
INKWELL_API inkwell_result inkwell_finish_recording(inkwell_arm* arm, uint64_t* samples, uint64_t* lost,
                                                    int* is_complete);

/* Losses since the arm was opened. */
typedef struct inkwell_losses {
  uint64_t poses;                 /* sent by the board, but not received */
  uint64_t poses_missed_by_servo; /* received while the servo was still being called */
  uint64_t slow_servo_calls;      /* calls of the servo that took longer than 1 ms on the PC's clock */
  double longest_servo_call_s;
} inkwell_losses;

INKWELL_API inkwell_result inkwell_get_losses(inkwell_arm* arm, inkwell_losses* losses);

/* Unit of a test pulse. */
typedef enum inkwell_pulse INKWELL_AS_INT {
  INKWELL_PULSE_V = 0, /* a voltage, with the current loop off */
  INKWELL_PULSE_A = 1  /* a current reference, at most the motor's limit */
} inkwell_pulse;

/* Sends one pulse of 0 to 0.1 s to motor 1, 2 or 3 in the state INKWELL_READY, and returns when the board has started
 * it. The arm rests for the same time after it. The signals current_1_A and duty_1 show it: a current is sampled at
 * the start of its control period, and a duty acts from the next period on. Select the signals first. */
INKWELL_API inkwell_result inkwell_send_test_pulse(inkwell_arm* arm, int motor, inkwell_pulse unit, double amplitude,
                                                   double duration_s);

#ifdef __cplusplus
}
#endif
#endif /* INKWELL_INKWELL_H */
