/* libinkwell: a haptic arm in a program of one's own.
 *
 *   inkwell_arm* arm = NULL;
 *   if (inkwell_open(NULL, &arm) != INKWELL_OK) { puts(inkwell_error_text()); return 1; }
 *   inkwell_enable_force(arm, 5.0);
 *   inkwell_start_servo(arm, my_servo, NULL);       // called at each pose, a thousand times a second
 *   ...
 *   inkwell_close(arm);
 *
 * Lengths are in metres, forces in newtons, angles in radians, times in seconds. Positions and forces are in the arm's
 * workspace axes; the Omni's are x to the right, y up, z to the user.
 *
 * Every function may be called from any thread, except that inkwell_close() must be the last one for its arm. None of
 * them throws or aborts; each returns a result, and inkwell_error_text() returns the error as a sentence.
 *
 * A forked child cannot use an arm that its parent has opened: each function is INKWELL_REFUSED there, but
 * inkwell_close(), which does nothing. A thread may be cancelled: it ends where it waits for a pose, samples, the force or
 * the end of a servo, else after the call. */
#ifndef INKWELL_INKWELL_H
#define INKWELL_INKWELL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define INKWELL_API __attribute__((visibility("default")))

/* Any int may come from C, so C++ must not take an enumeration for narrower. */
#ifdef __cplusplus
#define INKWELL_AS_INT : int
#else
#define INKWELL_AS_INT
#endif

/* How a function ended. */
typedef enum inkwell_result INKWELL_AS_INT {
  INKWELL_OK = 0,
  INKWELL_NO_DEVICE = 1,     /* no arm there, or more than one and none was named */
  INKWELL_NO_PERMISSION = 2, /* the user may not use the device */
  INKWELL_INCOMPATIBLE = 3,  /* its firmware belongs to another version of this library */
  INKWELL_DISCONNECTED = 4,  /* no poses come: the link is lost, or the device is silent; see below */
  INKWELL_IN_USE = 5,        /* another program has what only one can have */
  INKWELL_BAD_ARGUMENT = 6,  /* a value that the function can not take */
  INKWELL_REFUSED = 7,       /* the device does not take it, or not now */
  INKWELL_TIMED_OUT = 8,     /* what was waited for did not come */
  INKWELL_FAILED = 9,        /* anything else; the sentence says what */
  INKWELL_FORCE_LOST = 10    /* the force went off, and this program did not switch it off */
} inkwell_result;

/* INKWELL_DISCONNECTED ends by itself. After an unplugged cable or a restart of the board the library looks for the
 * same arm five times a second, and opens it again; a device that has been silent for 2 s is back with its next pose.
 * Until then no force is sent, and functions that return a pose write the last known one. Afterwards:
 *   - the force is off until inkwell_enable_force() is called again, except after a silence;
 *   - a servo has ended, and inkwell_servo_result() returns the cause;
 *   - selected signals have to be selected again, except after a silence;
 *   - a board that has restarted has its stored parameters.
 * A virtual board that inkwell_open() has started does not come back once it has ended. */

/* Version of the library, for example "0.2.0". */
INKWELL_API const char* inkwell_version(void);

/* What went wrong last in the calling thread, with what to do: a sentence, empty after none. Valid until the thread's
 * next call. */
INKWELL_API const char* inkwell_error_text(void);

/* ---- devices ------------------------------------------------------------------------------------------------ */

/* An arm that can be opened. */
typedef struct inkwell_device {
  char address[128];      /* for inkwell_open() */
  char serial_number[32]; /* empty where it is not known before the device is opened */
  char product[64];
  int is_virtual; /* what comes from it is a simulation */
} inkwell_device;

/* The arms on this computer's USB, and the virtual board that INKWELL_DEVICE names, if it does. Writes at most
 * `capacity` of them and tells in `count` how many there are. */
INKWELL_API inkwell_result inkwell_list_devices(inkwell_device* devices, size_t capacity, size_t* count);

/* An open arm. */
typedef struct inkwell_arm inkwell_arm;

/* What an address leads to. */
typedef enum inkwell_address_kind INKWELL_AS_INT {
  INKWELL_ON_USB = 0,    /* any text that is none of the others: a serial number, if it is one */
  INKWELL_AT_SERVER = 1, /* "usbip:HOST:PORT" or "usbip:unix:PATH" */
  INKWELL_OWN_BOARD = 2  /* "virtual" or "virtual:FILE": each opening makes a board of its own */
} inkwell_address_kind;

/* What kind of address inkwell_open() takes the text for, without looking there. */
INKWELL_API inkwell_result inkwell_kind_of_address(const char* address, inkwell_address_kind* kind);

/* Opens an arm. `address`:
 *   NULL or ""         what the environment's INKWELL_DEVICE says, else the only arm on USB
 *   a serial number    the arm on USB that has it
 *   "usbip:HOST:PORT"  the arm of a USB/IP server, such as a virtual board that runs already; "usbip:unix:PATH" at a
 *                      Unix socket
 *   "virtual"          a virtual board of its own, which is ready and ends with inkwell_close(); "virtual:FILE" with
 *                      the arm that FILE describes
 * The force is off. */
INKWELL_API inkwell_result inkwell_open(const char* address, inkwell_arm** arm);

/* Lets this program's force fade, ends the servo and forgets the arm. NULL is allowed. It waits for a call of the servo
 * that is under way, for ever if that does not return; its force has faded by then. In the servo itself it is
 * INKWELL_REFUSED, and the arm stays open. */
INKWELL_API inkwell_result inkwell_close(inkwell_arm* arm);

/* Who the device is, and what it has counted. */
typedef struct inkwell_information {
  char serial_number[32];
  char product[64];
  char firmware_version[16];
  int is_virtual;
  double servo_rate_Hz;          /* of the board's control interrupt */
  uint32_t servo_cycles_longest; /* longest control interrupt since the board started, processor cycles */
  uint32_t force_reports;        /* forces received from programs since the board started; this and the next three
                                    wrap after 49 days at one a millisecond */
  uint32_t force_reports_lost;
  uint32_t force_reports_late;
  uint32_t force_reports_refused;
  double motor_heat[3]; /* 1 is what the continuous current leads to; see INKWELL_MOTOR_HEAT_HOLDS_BACK */
} inkwell_information;

/* From this heat on a motor may get less current, and the force be weaker. */
#define INKWELL_MOTOR_HEAT_HOLDS_BACK 0.85f

/* Asks the device. */
INKWELL_API inkwell_result inkwell_get_information(inkwell_arm* arm, inkwell_information* information);

/* Characters of a board's name, with the zero at its end. */
#define INKWELL_BOARD_NAME_SIZE 32

/* The board that the device's firmware is for, such as "omni_driver"; empty if it tells none. A name that this library
 * has never heard of is no error. */
INKWELL_API inkwell_result inkwell_get_board_name(inkwell_arm* arm, char name[INKWELL_BOARD_NAME_SIZE]);

/* ---- pose --------------------------------------------------------------------------------------------------- */

/* What the board is doing. */
typedef enum inkwell_state INKWELL_AS_INT {
  INKWELL_STARTING = 0,
  INKWELL_UNREFERENCED = 1, /* the stylus has to rest in the inkwell once */
  INKWELL_READY = 2,        /* the pose is valid, the force is off */
  INKWELL_ACTIVE = 3,       /* the pose is valid, the force is on */
  INKWELL_FAULT = 4         /* the force is off, and inkwell_fault_text() says why; inkwell_is_referenced() tells
                               whether the pose is valid */
} inkwell_state;

/* Why the device is in INKWELL_FAULT. A code that is not here is of firmware that this library does not know. */
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

/* Whose force the hand feels: bits of inkwell_pose::force_sources. None of them is set while the force is off. */
enum inkwell_force_source {
  INKWELL_WALLS = 1,  /* the walls of the board's own box are felt */
  INKWELL_SHAPES = 2, /* planes or a sphere that a program placed */
  INKWELL_PROGRAM = 4 /* forces of a program */
};

/* What makes the force smaller than what the hand touches: bits of inkwell_pose::limits. None of them is a fault. */
enum inkwell_limit {
  INKWELL_LIMIT_FORCE = 1,   /* the force is held at force_limit_N, or on its way up to it */
  INKWELL_LIMIT_CURRENT = 2, /* a motor is at its own limit; all give way together, so the direction stays */
  INKWELL_LIMIT_CHANGE = 4,  /* the force changes as fast as force_change_N_per_s lets it */
  INKWELL_LIMIT_ENERGY = 8,  /* the hand got all the energy that it may: what drives the motion gives way */
  INKWELL_LIMIT_HEAT = 16,   /* a hot motor gives all that it still may; all give way together */
  INKWELL_LIMIT_SPEED = 32   /* the probe is nearly as fast as it may be: what drives the motion gives way */
};

/* What the board reports in a millisecond of the bus. */
typedef struct inkwell_pose {
  double time_s;     /* board time; it does not wrap while the arm is open */
  uint32_t sequence; /* one more for each millisecond of the bus; a gap is a pose that this program missed. It wraps
                        after 49 days, so compare by the difference in 32 bits */
  inkwell_state state;
  int fault;              /* one of inkwell_fault */
  uint32_t limits;        /* bits of inkwell_limit */
  double position_m[3];   /* of the probe, where the stylus is held */
  double velocity_m_s[3]; /* over the last 8 ms */
  double rotation[9];   /* of the stylus, row by row: columns are its x, y and z axis; z points out of its tip's back */
  double gimbal_rad[3]; /* yaw, pitch, roll */
  double joint_rad[3];
  double force_N[3];      /* that the board asks of the motors, everything together */
  uint32_t force_sources; /* bits of inkwell_force_source */
  int button_1, button_2; /* 1 while pressed */
  int in_inkwell;         /* 1 while the stylus rests in the inkwell */
  double supply_V;
} inkwell_pose;

/* The newest pose, without waiting. With INKWELL_DISCONNECTED it is the last known one. */
INKWELL_API inkwell_result inkwell_get_pose(inkwell_arm* arm, inkwell_pose* pose);

/* Waits for the next pose that this thread has not seen. With INKWELL_TIMED_OUT and INKWELL_DISCONNECTED `pose` is the
 * last known one. A lost link is INKWELL_DISCONNECTED without waiting; a silent device is waited for. */
INKWELL_API inkwell_result inkwell_wait_for_pose(inkwell_arm* arm, double timeout_s, inkwell_pose* pose);

/* Waits until this much board time has passed. A virtual board's time follows the program, not the PC's clock. If no
 * pose comes for 2 s it is INKWELL_TIMED_OUT. */
INKWELL_API inkwell_result inkwell_sleep(inkwell_arm* arm, double duration_s);

/* 1 while the arm knows where it is: since the stylus rested in the inkwell, and until counts may have been lost. With
 * 0 the newest pose's position, joints and rotation mean nothing, and its velocity is 0. */
INKWELL_API inkwell_result inkwell_is_referenced(inkwell_arm* arm, int* is_referenced);

/* Where the probe is for these joint angles, and how it moves: `jacobian`, row by row in m/rad, times the joints'
 * speeds is the probe's velocity; its transpose times a force is the joints' torques. Each may be NULL. */
INKWELL_API inkwell_result inkwell_forward_kinematics(inkwell_arm* arm, const double joint_rad[3], double position_m[3],
                                                      double jacobian[9]);

/* Cause and remedy of a fault's code; never NULL. */
INKWELL_API const char* inkwell_fault_text(int fault);
/* "over_speed" for INKWELL_FAULT_OVER_SPEED; NULL for a code that has no name. */
INKWELL_API const char* inkwell_fault_name(int fault);

/* ---- force -------------------------------------------------------------------------------------------------- */

/* One program drives an arm at a time, and the board decides which one. A program claims the arm by its first call of
 * inkwell_enable_force(), inkwell_set_force(), inkwell_start_servo() or inkwell_place_*(), and holds it until
 * inkwell_close(). If it ends without that, the board ends its claim after a second. While a program drives, these
 * calls, inkwell_disable_force(), inkwell_clear_fault() and changes of parameters are INKWELL_IN_USE in every other
 * program, and the sentence names the driver. Any program may read, record and call inkwell_stop(). */

/* Switches the force on: this is where the program says that a hand may feel it. Waits until the device is active, for
 * `timeout_s` of board time at most, and for 2 s of silence. In a fault or before the stylus was in the inkwell it is
 * INKWELL_REFUSED. The faults "usb_gone" and "host_silent" of a program that drove before this one, or before a lost
 * link, are cleared first. */
INKWELL_API inkwell_result inkwell_enable_force(inkwell_arm* arm, double timeout_s);
/* Lets the force fall to nothing within the parameter soft_landing_s, and returns once it is off. */
INKWELL_API inkwell_result inkwell_disable_force(inkwell_arm* arm);
/* Takes the force away at once, whichever program drives the arm, and returns once it is off. */
INKWELL_API inkwell_result inkwell_stop(inkwell_arm* arm);

/* Takes the arm over from the program that drives it. That program's force fades and its shapes end. */
INKWELL_API inkwell_result inkwell_take_over(inkwell_arm* arm);

/* The program that drives the arm. */
typedef struct inkwell_driver {
  int is_driven;       /* 0: no program drives the arm, and the rest is 0 */
  int is_this_arm;     /* it is driven through this arm object */
  uint32_t process_id; /* on the driver's computer */
  char program[32];    /* printable ASCII */
  double driven_s;     /* board time since it claimed the arm */
} inkwell_driver;

/* Asks the device. */
INKWELL_API inkwell_result inkwell_get_driver(inkwell_arm* arm, inkwell_driver* driver);
/* Clears a fault whose cause is gone, and waits for a fifth of a second whether it stays away; if the board tests
 * itself anew, until that is over. If the cause is still there it is INKWELL_REFUSED, and the sentence names the fault
 * that is there again with its remedy. Without a fault there is nothing to wait for. */
INKWELL_API inkwell_result inkwell_clear_fault(inkwell_arm* arm);

/* What becomes of the walls while a program sends forces. */
typedef enum inkwell_force_mode INKWELL_AS_INT {
  INKWELL_BESIDE_WALLS = 1,    /* the walls of the board's box are felt too */
  INKWELL_INSTEAD_OF_WALLS = 2 /* only what programs ask for */
} inkwell_force_mode;

/* How this program's forces and the board's walls go together; INKWELL_INSTEAD_OF_WALLS unless it is set. */
INKWELL_API inkwell_result inkwell_set_force_mode(inkwell_arm* arm, inkwell_force_mode mode);

/* The force on the hand until the next call. It goes out within a millisecond, at most one in each. The board moves to
 * it in a line, no further than its limit; without another call it fades after program_force_expiry_s. A value that is
 * infinite or no number is INKWELL_BAD_ARGUMENT, and the force before stays. Another program that drives the arm makes
 * it INKWELL_IN_USE. If the force went off by a fault, by another program or with the link, it is INKWELL_FORCE_LOST
 * until the force is on again or this program calls one of the functions that switch it. In the servo, return the force
 * instead. */
INKWELL_API inkwell_result inkwell_set_force(inkwell_arm* arm, const double force_N[3]);

/* Called at each pose, a thousand times a second, in a thread of the library. Writes the force on the hand, which is
 * 0 before and where it is infinite or no number. Returns 0 to go on, anything else to end the servo. See
 * inkwell_servo_result() for what else ends it. The time of a virtual board does not pass until it returns, so that it
 * misses no pose. */
typedef int (*inkwell_servo)(inkwell_arm* arm, const inkwell_pose* pose, double force_N[3], void* user);
/* Has `servo` called from now on, with `user` as it was given. */
INKWELL_API inkwell_result inkwell_start_servo(inkwell_arm* arm, inkwell_servo servo, void* user);
/* Waits until the servo is not called any more, except when called by the servo itself. */
INKWELL_API inkwell_result inkwell_stop_servo(inkwell_arm* arm);
/* 1 while the servo is being called. */
INKWELL_API int inkwell_servo_is_running(inkwell_arm* arm);
/* Why the last servo has ended, with the sentence. INKWELL_FORCE_LOST: a fault or another program switched the force
 * off. INKWELL_DISCONNECTED: the link was lost, or the device was silent. INKWELL_IN_USE: another program drives the
 * arm. INKWELL_OK: the program has ended it, it runs, or there was none. */
INKWELL_API inkwell_result inkwell_servo_result(inkwell_arm* arm);

/* ---- shapes ------------------------------------------------------------------------------------------------- */

/* Planes that the board renders at most. */
#define INKWELL_PLANES_MAXIMUM 8

/* How a shape feels. A shape whose life is 0 is not there. */
typedef struct inkwell_surface {
  double stiffness_N_per_m;
  double damping_Ns_per_m;
  double static_friction;  /* bound of the tangential force while it sticks, as a part of the normal force */
  double dynamic_friction; /* the same while it slides; at most the static one */
  /* The board forgets the shape after this time, at most 10 s, unless it is placed again. INFINITY: as long as the
   * program drives the arm. */
  double life_s;
} inkwell_surface;

/* Keeps the probe on one side. */
typedef struct inkwell_plane {
  double point_m[3];
  double normal[3]; /* into the free space, of any length but 0 */
  inkwell_surface surface;
} inkwell_plane;

/* Keeps the probe out of a ball. */
typedef struct inkwell_sphere {
  double centre_m[3];
  double radius_m; /* the free space is outside */
  inkwell_surface surface;
} inkwell_sphere;

/* Takes the place of all shapes, at one control period and without a jump of the force; the board renders them at its
 * full rate. The probe is a point to them. `sphere` may be NULL, `plane_count` 0. */
INKWELL_API inkwell_result inkwell_place_shapes(inkwell_arm* arm, const inkwell_plane* planes, size_t plane_count,
                                                const inkwell_sphere* sphere);

/* ---- parameters --------------------------------------------------------------------------------------------- */

/* A row of the table of parameters. */
typedef struct inkwell_parameter {
  const char* name; /* ends in its unit */
  const char* unit; /* "" for a pure number */
  const char* help;
  double minimum, maximum, default_value;
} inkwell_parameter;

/* Once an arm is open, with those of its own force law. */
INKWELL_API size_t inkwell_parameter_count(void);
/* Row `index` of the table; NULL beyond its end. */
INKWELL_API const inkwell_parameter* inkwell_parameter_at(size_t index);
/* Asks the device. An unknown name is INKWELL_BAD_ARGUMENT. */
INKWELL_API inkwell_result inkwell_get_parameter(inkwell_arm* arm, const char* name, double* value);
/* All of them take effect at one control period, or none does. */
INKWELL_API inkwell_result inkwell_set_parameters(inkwell_arm* arm, const char* const* names, const double* values,
                                                  size_t count);

/* ---- what outlives the board's power ------------------------------------------------------------------------- */

/* Parameters that are set last until the board loses its power, unless they are stored. The board
 * neither stores nor forgets while the force is on or may come at once: that is INKWELL_REFUSED, with the reason. */

/* Has the board keep its parameters as they are now; they are safe when this returns. */
INKWELL_API inkwell_result inkwell_store_parameters(inkwell_arm* arm);
/* Gives every parameter what is stored, in one transaction. INKWELL_REFUSED if nothing is. */
INKWELL_API inkwell_result inkwell_restore_parameters(inkwell_arm* arm);
/* Has the board forget what it has stored, the calibration of its arm too; every parameter gets its default. */
INKWELL_API inkwell_result inkwell_factory_reset(inkwell_arm* arm);
/* The value that the board's next start gives this parameter: the stored one, or the default. */
INKWELL_API inkwell_result inkwell_get_stored_parameter(inkwell_arm* arm, const char* name, double* value);

/* What the board has stored. */
typedef enum inkwell_stored INKWELL_AS_INT {
  INKWELL_STORED_NOTHING = 0,
  INKWELL_STORED_PARAMETERS = 1,
  INKWELL_STORED_FACTORY_RESET = 2, /* what was stored before is forgotten */
  INKWELL_STORED_OTHER_SCHEMA = 3   /* by a firmware whose records this one cannot read */
} inkwell_stored;

/* The state of the board's store. */
typedef struct inkwell_store {
  inkwell_stored contents;
  uint32_t not_stored;       /* parameters that would be lost with the power */
  uint32_t stores_left;      /* before the board's next start, which makes room */
  uint32_t records_written;  /* in the board's life */
  uint32_t sector_erases[2]; /* likewise, of each of its two sectors */
} inkwell_store;

/* Asks the device. */
INKWELL_API inkwell_result inkwell_get_store(inkwell_arm* arm, inkwell_store* store);

/* ---- the board's self-test ------------------------------------------------------------------------------------- */

/* What an item of the self-test came to. */
typedef enum inkwell_test INKWELL_AS_INT {
  INKWELL_TEST_NOT_DONE = 0, /* it has not been looked at, or could not be while something else fails */
  INKWELL_TEST_PASSED = 1,
  INKWELL_TEST_FAILED = 2,
  INKWELL_TEST_MOVED = 3,     /* not done: the arm moved too fast */
  INKWELL_TEST_NO_PART = 4,   /* not done: a motor with a current limit of 0 takes no part */
  INKWELL_TEST_BROKEN_OFF = 5 /* not done: no supply, or another fault came before it was over */
} inkwell_test;

/* An item of the self-test. Texts last until the process ends. */
typedef struct inkwell_test_item {
  const char* name;
  const char* meaning; /* what it means if it passes */
  const char* remedy;  /* if it fails */
  const char* unit;    /* of the figure; empty if the item has none */
  double figure;       /* 0 if the item has none, or was not looked at */
  inkwell_test result;
  int takes_force; /* a failure takes the force away, until a test passes */
} inkwell_test_item;

/* Has the board test itself, which takes a twentieth of a second; the motors get small pulses. `count` is how many
 * items there are, of which the first `capacity` are written. INKWELL_REFUSED while the force is on or another fault is
 * shown. A failed item is no error: its result says so. */
INKWELL_API inkwell_result inkwell_self_test(inkwell_arm* arm, inkwell_test_item* items, size_t capacity,
                                             size_t* count);
/* What the newest test has found, that of the board's start included, without a new one. */
INKWELL_API inkwell_result inkwell_get_self_test(inkwell_arm* arm, inkwell_test_item* items, size_t capacity,
                                                 size_t* count);

/* ---- the hand of a virtual board ------------------------------------------------------------------------------ */

/* The simulated hand takes the stylus out of the inkwell and pulls the probe to `target_m` as a spring of
 * `stiffness_N_per_m` with a hundredth of that as damping would. Only on an arm that was opened as "virtual", as the
 * next two; INKWELL_REFUSED on any other. */
INKWELL_API inkwell_result inkwell_move_virtual_hand(inkwell_arm* arm, const double target_m[3],
                                                     double stiffness_N_per_m);
/* It lets go, so that the arm falls as a real one would. */
INKWELL_API inkwell_result inkwell_release_virtual_hand(inkwell_arm* arm);
/* It presses (1) or lets go of (0) the buttons of the stylus. */
INKWELL_API inkwell_result inkwell_press_virtual_buttons(inkwell_arm* arm, int button_1, int button_2);

/* ---- scope and recording ------------------------------------------------------------------------------------ */

/* A row of the table of signals. */
typedef struct inkwell_signal {
  const char* name; /* ends in its unit */
  const char* unit;
  const char* help;
} inkwell_signal;

/* Once an arm is open, with those of its own force law. */
INKWELL_API size_t inkwell_signal_count(void);
/* Row `index` of the table; NULL beyond its end. */
INKWELL_API const inkwell_signal* inkwell_signal_at(size_t index);

/* Streams these signals at every control period from now on; none stops it. Only one program can have the scope: from
 * its first selection until it selects none. */
INKWELL_API inkwell_result inkwell_select_signals(inkwell_arm* arm, const char* const* names, size_t count);

/* Takes samples that have come: waits until there are some, then writes at most `capacity` rows of one value for each
 * selected signal to `values`, their control periods to `periods` (which may be NULL) and their number to `count`.
 * `lost` (may be NULL) tells how many samples were missing before them. A time-out gives INKWELL_OK and 0 rows. */
INKWELL_API inkwell_result inkwell_read_scope(inkwell_arm* arm, double timeout_s, float* values, uint32_t* periods,
                                              size_t capacity, size_t* count, uint64_t* lost);

/* The same with control periods that do not wrap: inkwell_read_scope() writes their lower 32 bits, which wrap after 59
 * hours. Divided by servo_rate_Hz they are times as inkwell_pose::time_s. */
INKWELL_API inkwell_result inkwell_read_samples(inkwell_arm* arm, double timeout_s, float* values, int64_t* periods,
                                                size_t capacity, size_t* count, uint64_t* lost);

/* Records the selected signals into a file (HDF5, or CSV by its ending) until inkwell_stop_recording(). */
INKWELL_API inkwell_result inkwell_start_recording(inkwell_arm* arm, const char* path);
/* Finishes the file and tells how many samples it has and how many were lost; both may be NULL. */
INKWELL_API inkwell_result inkwell_stop_recording(inkwell_arm* arm, uint64_t* samples, uint64_t* lost);

#ifdef __cplusplus
}
#endif
#endif /* INKWELL_INKWELL_H */
