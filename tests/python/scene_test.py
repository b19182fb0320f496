"""Objects from numpy arrays and primitives are felt, move, and report contacts and events."""

import unittest

import inkwell
import numpy as np

from virtual_board import FREE_POINT_M, make_active, wait_until

TIP_RADIUS_M = 0.005
CUBE_M = 0.02 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                  [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
MIDDLE_M = (0, 0, -0.06)
PRESSED_M = (0, 0, -0.035 - 0.007)
PRESSED_N = 0.007 * 300 * 1000 / 1300  # the springs of hand and object
WOOD = inkwell.Material.named("wood")


class Scenes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arm = inkwell.open("virtual", seed=1)
        make_active(cls.arm)

    @classmethod
    def tearDownClass(cls):
        cls.arm.close()

    def setUp(self):
        self.scene = self.arm.scene
        self.lift()

    def lift(self):
        self.scene.clear()
        self.arm.virtual_hand.move(FREE_POINT_M)
        self.arm.sleep(0.3)
        self.scene.events()

    def press(self):
        self.arm.virtual_hand.move(PRESSED_M)
        self.arm.sleep(0.4)
        return self.arm.pose.force_N[2]

    def test_a_mesh_from_arrays_of_each_type_is_felt_and_has_contacts_and_events(self):
        for vertex_type, face_type in ((np.float64, np.int64), (np.float32, np.uint32), (np.float16, np.int16)):
            with self.subTest(vertex_type.__name__):
                vertices_m = CUBE_M.astype(vertex_type)
                before = vertices_m.copy()
                cube = self.scene.add(vertices_m, FACES.astype(face_type), position_m=MIDDLE_M, material=WOOD)
                self.assertAlmostEqual(self.press(), PRESSED_N, delta=0.15)
                np.testing.assert_array_equal(vertices_m, before)
                contact, = self.scene.contacts
                self.assertEqual(contact.object, cube.number)
                self.assertIn(contact.triangle, (10, 11))  # the faces with the largest z
                np.testing.assert_allclose(contact.normal, (0, 0, 1), atol=1e-3)
                self.assertAlmostEqual(contact.point_m[2], -0.04, delta=1e-4)
                self.assertAlmostEqual(contact.depth_m, 0.001 * PRESSED_N, delta=2e-4)
                touched, = self.scene.events()
                self.assertEqual((touched.kind, touched.button), (inkwell.EventKind.TOUCHED, 0))
                self.assertEqual(touched.contact.object, cube.number)
                self.assertLess(touched.time_s, contact.time_s)
                self.assertIn("TOUCHED", repr(touched))
                self.arm.virtual_hand.press(button_1=True)
                self.arm.sleep(0.05)
                pressed, = self.scene.events()
                self.assertEqual((pressed.kind, pressed.button), (inkwell.EventKind.PRESSED, 1))
                self.arm.virtual_hand.press()
                self.arm.sleep(0.05)
                self.lift()

    def test_arrays_that_the_library_can_read_are_not_copied(self):
        from inkwell.scene import _rows_of_three
        for given, kinds, types in ((CUBE_M, "fiu", (np.float32, np.float64)), (FACES, "iu", (np.int32, np.int64))):
            self.assertIs(_rows_of_three(given, kinds, types, "rows"), given)

    def test_primitives_move_and_change_their_material(self):
        for add, top_m in ((lambda: self.scene.add_sphere(0.02, position_m=MIDDLE_M, material="wood"), 0.02),
                           (lambda: self.scene.add_box((0.02, 0.02, 0.02), position_m=MIDDLE_M, material="wood"), 0.02),
                           (lambda: self.scene.add_cylinder(0.02, 0.02, position_m=MIDDLE_M, material="wood"), 0.02),
                           (lambda: self.scene.add_capsule(0.015, 0.005, position_m=MIDDLE_M, material="wood"), 0.02),
                           (lambda: self.scene.add_half_space(position_m=(0, 0, -0.04), material="wood"), 0)):
            thing = add()
            self.assertAlmostEqual(self.press(), PRESSED_N, delta=0.2)
            thing.set_material(inkwell.Material(stiffness_N_per_m=100))
            self.arm.sleep(0.3)
            self.assertAlmostEqual(self.arm.pose.force_N[2], 0.007 * 300 * 100 / 400, delta=0.15)
            thing.set_material("wood")
            for i in range(20):
                thing.move((0, 0, -0.04 - top_m - 0.0005 * i), velocity_m_per_s=(0, 0, -0.05))
                self.arm.sleep(0.01)
            self.arm.sleep(0.2)
            self.assertLess(self.arm.pose.force_N[2], 0.01)
            thing.remove()
            with self.assertRaisesRegex(inkwell.BadArgument, "The scene does not contain object"):
                thing.remove()
            self.lift()

    def test_wrong_arguments_are_refused_and_change_nothing(self):
        for words, vertices, faces in (("vertices have the shape \\(24,\\)", CUBE_M.ravel(), FACES),
                                       ("faces have the shape \\(12, 2\\)", CUBE_M, FACES[:, :2]),
                                       ("A coordinate of vertex 0 is nan", CUBE_M * np.nan, FACES),
                                       ("Triangle 0 has the vertex", CUBE_M, FACES + 8),
                                       ("Triangle 0 has the vertex -8", CUBE_M, FACES - 8),
                                       ("The mesh is empty", CUBE_M, np.zeros((0, 3), int))):
            with self.assertRaisesRegex(inkwell.BadArgument, words):
                self.scene.add(vertices, faces)
        for words, vertices, faces in (("faces have the type float64. Give whole numbers", CUBE_M, FACES.astype(float)),
                                       ("vertices have the type complex128", CUBE_M * 1j, FACES)):
            with self.assertRaisesRegex(TypeError, words):
                self.scene.add(vertices, faces)
        with self.assertRaisesRegex(inkwell.BadArgument, "The material soap does not exist. Give one of these: wood"):
            self.scene.add_sphere(0.01, material="soap")
        with self.assertRaisesRegex(TypeError, "The material is 7"):
            self.scene.add_sphere(0.01, material=7)
        with self.assertRaisesRegex(TypeError, "Give a placement"):
            self.scene.add_sphere(0.01, position_m=(0, 0))
        with self.assertRaisesRegex(inkwell.BadArgument, "A size of the object is 0 m"):
            self.scene.add_sphere(0)
        ball = self.scene.add_sphere(0.01, position_m=(0, 0, 1))
        with self.assertRaisesRegex(inkwell.BadArgument, "A coordinate of the object"):
            ball.move((0, 0, np.inf))
        self.assertLess(abs(self.press()), 1e-6)
        self.assertEqual(self.scene.lost_events, 0)


if __name__ == "__main__":
    unittest.main()
