"""Uses the page of `ricochet explore` as a visitor does, in headless Chromium: drags, keys, links, screenshots. What it
shows is compared with what `ricochet solve` answers to the scene that the page copies out.

usage: explore_page.py RICOCHET DIRECTORY

It needs chromium and chromium-driver of Debian, and writes screenshots into the directory.
"""

import json
import re
import subprocess
import sys
import time
import unittest
from pathlib import Path

from browser import Browser, CUT_OFF, CUT_OFF_IN_PICTURES, SMALLEST_TEXT

DIRECTORY, RICOCHET = [Path(sys.argv.pop()).resolve() for _ in range(2)]
SCENES = ["pendulum", "planar_body", "spatial_body", "body_pair", "linkage", "planar_contact"]
LEAST_TEXT_PX = 10
SETTLED = "return document.getElementById('verdict').ariaBusy !== 'true' && !isAsking && !frame"

# Counts the calls of each kind that are under way, from before the first one.
COUNT_CALLS = """
  const ask = window.fetch, now = {};
  window.most = {};
  window.fetch = async (address, options) => {
    const kind = address.split('/').pop();
    now[kind] = (now[kind] ?? 0) + 1;
    window.most[kind] = Math.max(window.most[kind] ?? 0, now[kind]);
    try { return await ask(address, options); } finally { --now[kind]; }
  };"""

# These can be used: with the keys, a group of radio buttons is one thing.
USABLE = """
  return [...document.querySelectorAll('button, input, textarea, summary, .handle')].filter(
    one => one.checkVisibility() && !one.disabled && (one.type !== 'radio' || one.checked)).length"""


def ricochet(*arguments):
    return subprocess.run([RICOCHET, *arguments], check=True, capture_output=True, text=True, timeout=60).stdout


def number(text):
    """The number that the page shows."""
    powers = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-")
    return float(re.sub(r"·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", r"e\1", text).translate(powers))


class ExplorePageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        DIRECTORY.mkdir(parents=True, exist_ok=True)
        cls.engine = subprocess.Popen([RICOCHET, "explore"], stdout=subprocess.PIPE, text=True)
        cls.addClassCleanup(cls.stop_engine)
        cls.url = cls.engine.stdout.readline().strip()
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    @classmethod
    def stop_engine(cls):
        cls.engine.terminate()
        cls.engine.wait(20)
        cls.engine.stdout.close()

    def setUp(self):
        self.browser.console()  # Chromium notes every refused call there; those of the last test are not this one's.

    def open(self, scene, width=1280, scheme="light"):
        self.browser.look_like(width, scheme)
        self.browser.open("about:blank")
        self.browser.open(f"{self.url}#at={scene}")
        self.settle()

    def settle(self):
        """Waits until no change is under way, and the answer to the last one is drawn."""
        time.sleep(0.15)
        for _ in range(200):
            if self.browser.script(SETTLED):
                break
            time.sleep(0.05)
        time.sleep(0.15)

    def text(self, selector):
        return self.browser.script(f"return document.querySelector({json.dumps(selector)}).textContent")

    def place(self, selector):
        """The middle of an element in the window, which scrolls there."""
        return self.browser.script(
            f"const e = document.querySelector({json.dumps(selector)}); e.scrollIntoView({{block: 'center'}});"
            "const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2];")

    def mouse(self, kind, x, y):
        self.browser.command("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)

    def drag(self, selector, right, up, steps=12):
        x, y = self.place(selector)
        self.mouse("mousePressed", x, y)
        for i in range(1, steps + 1):
            self.mouse("mouseMoved", x + right * i / steps, y - up * i / steps)
        self.mouse("mouseReleased", x + right, y - up)
        self.settle()

    def key(self, name):
        for kind in ("keyDown", "keyUp"):
            self.browser.command("Input.dispatchKeyEvent", type=kind, key=name, code=name,
                                 windowsVirtualKeyCode={"Tab": 9, "ArrowRight": 39}[name])

    def rows(self, table):
        """The texts of the cells of a table."""
        return self.browser.script(
            f"return [...document.querySelectorAll('#{table} tr')].map(r => [...r.children].map(c => c.textContent))")

    def assert_holds(self, shown_range, shown):
        low, high = map(number, shown_range.split(" … "))
        self.assertTrue(low <= number(shown) <= high, (shown_range, shown))

    def assert_shows_the_answer_of_its_scene(self):
        scene = DIRECTORY / "copied.textproto"
        self.browser.script("[...document.querySelectorAll('#forms button')].find(b => b.textContent == 'textproto').click()")
        scene.write_text(self.browser.script("return document.getElementById('copied').value"), encoding="utf-8")
        solved = json.loads(ricochet("solve", "--scene", str(scene), "--format", "json"))["outcome"]
        sentence = ricochet("solve", "--scene", str(scene)).splitlines()[0]
        self.assertTrue(self.text("#sentence").startswith(sentence), (self.text("#sentence"), sentence))
        self.assertEqual(self.text("#state").startswith("✓"), solved["admissible"])
        rows = self.browser.script("return [...document.querySelectorAll('#motion tr')].map(r => r.children[2].textContent)")
        after = solved["contact_velocity_after"]
        for shown, exact in zip(rows, [*after["tangential_m_s"], after["normal_m_s"]]):
            self.assertAlmostEqual(number(shown), exact, delta=abs(exact) * 1e-4)
        for law in ("newton", "poisson", "energetic"):
            shown = self.browser.script(f"return document.querySelector('input[value={law}] ~ b').textContent")
            exact = solved["coefficients"][law]
            self.assertAlmostEqual(number(shown), exact, delta=abs(exact) * 1e-4)
        for _, here, *ranges in self.rows("possible")[:3] if solved["admissible"] else []:
            for one in ranges if "–" not in ranges else ranges[:1]:
                self.assert_holds(one, here)
        change = self.browser.script("return [...document.querySelectorAll('#energy .strong')].at(-1).textContent")
        self.assertAlmostEqual(number(change), solved["energy_change_j"], delta=abs(solved["energy_change_j"]) * 1e-2)

    def test_each_scene_is_drawn_and_right(self):
        for scene in SCENES:
            with self.subTest(scene=scene):
                self.open(scene)
                self.assert_shows_the_answer_of_its_scene()
                for picture, least in (("strike", 8), ("course", 12), ("energy", 15), ("over", 20), ("strip", 2)):
                    self.assertGreaterEqual(self.browser.script(
                        f"return document.querySelectorAll('#{picture} .layer *').length"), least, picture)
                self.browser.screenshot(DIRECTORY / f"explore-{scene}.png")
        self.assertEqual(self.browser.console(), [])

    def several_shown(self):
        """The numbers of the outcomes that the page shows, by their names, and those of its scene from the command line."""
        scene = DIRECTORY / "copied.textproto"
        self.browser.script("[...document.querySelectorAll('#forms button')].find(b => b.textContent == 'textproto').click()")
        scene.write_text(self.browser.script("return document.getElementById('copied').value"), encoding="utf-8")
        answer = json.loads(ricochet("multicontact", "--scene", str(scene), "--format", "json"))["answers"][0]
        rows = self.rows("several")
        for i in (1, 2, 3):
            for row in rows[:-1]:
                self.assert_holds(rows[-1][i], row[i])
        exact = {one["orders"][0]: one["velocity"] for one in answer["orders"]}
        return ({name: [number(text) for text in texts[:3]] for name, *texts in rows if name != "possible"},
                {**exact, "springs": answer["springs"]["velocity"]})

    def assert_shows_the_outcomes_of_its_scene(self):
        shown, exact = self.several_shown()
        self.assertEqual(shown.keys(), exact.keys())
        for name, numbers in exact.items():
            for one, other in zip(shown[name], numbers):
                self.assertAlmostEqual(one, other, delta=abs(other) * 1e-4 + 1e-12)
        return exact

    def test_two_contacts_turn_by_their_stiffness(self):
        for scene in ("box_on_two_feet", "planar_body"):  # By a link, and from another scene.
            self.open(scene)
            self.browser.script("document.querySelector('[data-at=box_on_two_feet]').click()")
            self.settle()
            exact = self.assert_shows_the_outcomes_of_its_scene()
        self.assertIn("The order matters.", self.text("#sentence"))
        self.assertAlmostEqual(exact["springs"][2], 0, delta=1e-12)
        self.browser.screenshot(DIRECTORY / "explore-box.png")
        self.drag("#spread .handle", 60, 0)
        stiffer = self.assert_shows_the_outcomes_of_its_scene()["springs"][2]
        self.assertGreater(stiffer, 0.05)
        for width in (320, 400):
            self.open("box_on_two_feet", width, "dark")
            self.assertEqual(self.browser.script("return document.documentElement.scrollWidth"), width)
        self.assertEqual(self.browser.script(CUT_OFF) + self.browser.script(CUT_OFF_IN_PICTURES), [])
        self.browser.screenshot(DIRECTORY / "explore-box-400-dark.png")
        self.browser.script("document.querySelector('[data-at=pendulum]').click()")
        self.settle()
        self.assert_shows_the_answer_of_its_scene()
        self.assertEqual(self.browser.console(), [])

    def test_a_stiffness_beyond_the_picture_can_be_dragged_back(self):
        field = "contacts[1].relative_stiffness"
        self.open("box_on_two_feet")
        limits = f"return [inputs['{field}'].slider.min, inputs['{field}'].slider.max]"
        usual = self.browser.script(limits)
        for refused in (0, -1):
            self.browser.script(f"change('{field}', {refused})")
            self.settle()
            self.assertEqual(self.browser.script(limits), usual)
            self.assertIn("relative_stiffness", self.text("#leaves"))
        for stiffness, mark in ((1e-4, "◀ 0.0001"), (1e4, "▶ 10000")):
            self.browser.script(f"change('{field}', {stiffness})")
            self.settle()
            self.assertIn(mark, self.text("#spread"))
            self.browser.screenshot(DIRECTORY / "explore-box-stiff.png")
        self.drag("#spread .handle", -100, 0)
        self.assertTrue(0.01 <= self.browser.script(f"return get('{field}')") < 100)
        self.assertNotIn("▶", self.text("#spread"))
        self.assert_shows_the_outcomes_of_its_scene()

    def test_a_coefficient_beyond_the_picture_is_marked(self):
        self.open_fields({"pendulum.inertia_kg_m2": 1, "pendulum.a_m": 0.3, "pendulum.b_m": 3,
                          "pendulum.omega_minus_rad_s": -1, "friction.kinetic_coefficient": 0.09,
                          "restitution.energetic": 1})
        self.assertIn("▲ 4.36", self.text("#over"))
        self.browser.screenshot(DIRECTORY / "explore-beyond.png")

    def test_a_link_holds_a_mechanism_of_many_coordinates(self):
        n = 7
        numbers = {"mass_matrix": [int(i % (n + 1) == 0) for i in range(n * n)],
                   "jacobian": [int(i % (n + 1) == 0) for i in range(3 * n)], "rates": [0.3, 0, -1, 0, 0, 0, 0.1]}
        fields = [f"mechanism.{name}[{i}]={value}"
                  for name, values in numbers.items() for i, value in enumerate(values)]
        self.open("&".join(["yours", *fields, "mechanism.composite=true", "friction.kinetic_coefficient=0.2",
                            "restitution.newton=0.5"]))
        self.assert_shows_the_answer_of_its_scene()
        after = self.browser.script("return answers.solve.answer.outcome.rates_after[2]")
        shown = {row[0]: row[2] for row in self.rows("motion")}
        self.assertAlmostEqual(number(shown["q′3"]), after, delta=1e-4)
        # All numbers have a slider: those of the mechanism, friction and restitution.
        self.assertEqual(self.browser.script("return document.querySelectorAll('.field').length"), len(fields) + 2)
        self.browser.script("[...document.querySelectorAll('#forms button')].find(b => b.textContent == 'Python')"
                            ".click()")
        self.assertIn('"composite": True', self.browser.script("return document.getElementById('copied').value"))
        self.assertEqual(self.browser.console(), [])

    def test_can_be_read_on_wide_and_narrow_screens(self):
        for width in (1600, 1280, 800, 400):
            for scheme in ("light", "dark"):
                for scene in ("planar_body", "spatial_body") if width in (1280, 400) else ("linkage",):
                    with self.subTest(width=width, scheme=scheme, scene=scene):
                        self.open(scene, width, scheme)
                        self.assertEqual(self.browser.script("return document.documentElement.scrollWidth"), width)
                        self.assertEqual(self.browser.script(CUT_OFF), [])
                        self.assertEqual(self.browser.script(CUT_OFF_IN_PICTURES), [])
                        self.assertGreaterEqual(self.browser.script(SMALLEST_TEXT), LEAST_TEXT_PX)
                        self.browser.screenshot(DIRECTORY / f"explore-{scene}-{width}-{scheme}.png")
        self.assertEqual(self.browser.console(), [])

    def test_the_strip_says_what_the_verdict_says(self):
        for scene, frictions in (("pendulum", ("0.289", "0.291", "0.2999", "0.3", "0.301", "0.001", "5")),
                                 ("planar_body", ("0.494", "0.4944", "0.62", "0.622"))):
            self.open(scene)
            for friction in frictions:
                self.browser.script(f"change(MU, {friction})")
                self.settle()
                shown = self.text("#strip .here title")
                self.assertEqual(shown, self.browser.script(
                    "return BEHAVIOUR[columnsOf('over').regimes[columnsOf('over').mu.indexOf(get(MU))]]"))
                if scene == "pendulum":
                    self.assertEqual(shown, "locks" if float(friction) >= 0.3 else "rebounds")
        # The pendulum locks from a/|b| on, where the strip begins to say so.
        self.open("pendulum")
        at, width = self.browser.script(
            "const b = $('strip').querySelectorAll('rect')[1]; return [b.x.baseVal.value, $('strip').viewBox.baseVal.width];")
        self.assertAlmostEqual(at / width * 2, 0.3, delta=1e-5)

    def test_stick_reversal_and_jamming_are_found_by_dragging_alone(self):
        self.open("pendulum")
        self.drag("#over .handle", 90, 0)
        self.assertIn("Locked", self.text("#sentence"))
        self.assert_shows_the_answer_of_its_scene()
        self.open("planar_body")
        self.assertIn("Sliding", self.text("#sentence"))
        self.drag("#strike .handle[data-id=velocity]", 260, 0)
        self.assertIn("reverses", self.text("#sentence"))
        self.assert_shows_the_answer_of_its_scene()
        self.open("planar_body")
        self.drag("#over .handle", 60, 0)
        self.assertIn("sticks", self.text("#sentence"))
        self.drag("#over .handle", 110, 0)
        self.assertIn("jams", self.text("#sentence"))
        self.assert_shows_the_answer_of_its_scene()
        self.drag("#strike .handle[data-id=middle]", -100, 40)
        self.assert_shows_the_answer_of_its_scene()
        self.assertGreater(self.browser.script("return document.querySelectorAll('.ghost').length"), 2)

    ROD = {"planar_body.mass_kg": 1, "planar_body.inertia_com_kg_m2": 0.0833, "planar_body.offset_t_m": 0.2,
           "planar_body.offset_n_m": -0.458, "planar_body.velocity_t_m_s": 1, "planar_body.velocity_n_m_s": -1,
           "planar_body.rate_rad_s": 0.5}

    def open_fields(self, fields):
        self.open("&".join(["x", *(f"{name}={value}" for name, value in fields.items())]))

    def test_friction_that_depends_on_the_speed_is_set_on_the_axis_that_is_drawn(self):
        self.open_fields({**self.ROD, "friction.kinetic_coefficient": 1.3, "friction.by_speed.power_law.alpha": 0.6,
                          "friction.by_speed.power_law.exponent": 1, "restitution.energetic": 0.8})
        self.drag("#over .handle", 1, 0)
        stated, effective = self.browser.script("return [get(MU), answers.solve.answer.outcome.effective.kinetic]")
        self.assertAlmostEqual(stated, 1.31, delta=0.02)
        marked = re.search(r"can hold from ([0-9.]+)", self.text("#strip")).group(1)
        stick = self.browser.script("return answers.bounds.answer.bounds.critical.stick")
        self.assertAlmostEqual(float(marked), stick * stated / effective, delta=1e-3)

    def test_restitution_that_depends_on_the_speed_is_named_as_it_is_there(self):
        self.open_fields({**self.ROD, "friction.kinetic_coefficient": 0.3, "restitution.by_speed.power_law.alpha": 0.5,
                          "restitution.by_speed.power_law.exponent": 1, "restitution.energetic": 0.8})
        self.assertIn("It takes 0.8 (0.44 at this speed) for the ratio", self.text("#simulator-note"))
        # What a contact can return does not depend on what the scene states.
        self.assertAlmostEqual(self.browser.script("return Math.max(...columnsOf('elastic').values[2])"), 1, delta=1e-9)

    def test_newton_s_law_is_shown_to_create_energy(self):
        self.open("linkage")
        self.assertIn("of energy would come from nothing", self.text("#simulator-note"))
        self.assertIn("not possible", self.text("#simulator tr:last-child td:last-child"))

    def test_a_drag_asks_once_at_a_time_and_ends_with_the_newest_answer(self):
        self.open("planar_body")
        self.browser.script(COUNT_CALLS)
        self.drag("#over .handle", 120, 0, steps=60)
        most = self.browser.script("return window.most")
        self.assertEqual(most, {"answers": 1})
        self.assert_shows_the_answer_of_its_scene()

    def test_a_drag_draws_answers_as_they_come(self):
        self.open("planar_body")
        self.browser.script("""
          window.drawn = [];
          new MutationObserver(() => window.drawn.push(performance.now())).observe($('motion'), {childList: true});""")
        self.drag("#over .handle", 150, 0, steps=150)
        drawn = self.browser.script("return window.drawn")
        self.assertGreater(len(drawn), 10)
        print(f"a drag of friction: {(len(drawn) - 1) / (drawn[-1] - drawn[0]) * 1e3:.0f} answers drawn a second")

    def test_the_keys_reach_everything_and_move_it(self):
        self.open("planar_body")
        self.browser.script("document.querySelector('details').open = true")
        reached = set()
        for _ in range(80):
            self.key("Tab")
            reached.add(self.browser.script("""
              const e = document.activeElement;
              e.number ??= window.count = (window.count ?? 0) + 1;
              return e === document.body ? 0 : e.number;"""))
            if 0 in reached and len(reached) > 1:
                break
        self.assertEqual(len(reached - {0}), self.browser.script(USABLE))
        for handle in ("#strike .handle[data-id=velocity]", "#strike .handle[data-id=middle]", "#over .handle"):
            before = self.text("#leaves")
            self.browser.script(f"document.querySelector('{handle}').focus()")
            self.key("ArrowRight")
            self.settle()
            self.assertNotEqual(self.text("#leaves"), before, handle)
            self.assert_shows_the_answer_of_its_scene()

    def test_stating_another_coefficient_keeps_the_impact(self):
        self.open("planar_contact")
        before = self.text("#leaves").split(" m/s")[0]
        self.browser.script("document.querySelector('input[value=newton]').click()")
        self.settle()
        self.assertIn("restitution.newton=0.67", self.browser.script("return location.hash"))
        self.assertEqual(self.text("#leaves").split(" m/s")[0], before)
        self.assert_shows_the_answer_of_its_scene()

    def test_stating_another_coefficient_loses_no_number(self):
        def choose(law):
            self.browser.script(f"document.querySelector('input[value={law}]').click()")
            self.settle()
            return self.browser.script("return scene.restitution")
        separating = {**self.ROD, "planar_body.velocity_n_m_s": 3, "restitution.energetic": 0.8}
        for fields in (separating, {**separating, "friction.kinetic_coefficient": -1}):
            self.open_fields(fields)
            self.assertEqual(choose("poisson"), {"poisson": 0.8})
        self.open_fields({**self.ROD, "restitution.by_speed.power_law.alpha": 0.5, "friction.kinetic_coefficient": 0.3,
                          "restitution.by_speed.power_law.exponent": 1, "restitution.energetic": 0.8})
        before = self.text("#leaves").split(" m/s")[0]
        self.assertEqual(choose("newton")["by_speed"], {"power_law": {"alpha": 0.5, "exponent": 1}})
        self.assertEqual(self.text("#leaves").split(" m/s")[0], before)
        self.open("planar_contact")
        self.browser.script("put(MU, 0.2); document.querySelector('input[value=poisson]').click()")  # No answer yet.
        self.settle()
        self.assertEqual(self.browser.script("return scene.restitution.poisson"), 1)

    def test_the_address_holds_the_scene(self):
        self.open("planar_body")
        self.drag("#over .handle", 60, 0)
        shown, address = self.text("#leaves"), self.browser.script("return location.href")
        self.browser.open("about:blank")
        self.browser.open(address)
        self.settle()
        self.assertEqual(self.text("#leaves"), shown)
        self.browser.open("about:blank")
        self.browser.open(f"{self.url}#at=x&pendulum.a_m=1&pendulum.__proto__.polluted=1&constructor.prototype.polluted=1")
        self.settle()
        self.assertTrue(self.browser.script("return ({}).polluted === undefined && Object.polluted === undefined"))

    def test_the_address_holds_a_law_of_defaults(self):
        for law in ({"brach": "{}"}, {"brach.e": 0.5}):
            self.open_fields({**self.ROD, "friction.kinetic_coefficient": 0.3, **law})
            shown, law_there = self.text("#leaves"), self.browser.script("return JSON.stringify(scene.brach)")
            self.assertIn("v = ", shown)
            address = self.browser.script("return location.href")
            self.browser.open("about:blank")
            self.browser.open(address)
            self.settle()
            self.assertEqual([self.text("#leaves"), self.browser.script("return JSON.stringify(scene.brach)")],
                             [shown, law_there])

    def test_an_address_with_the_name_of_no_scene_opens_one(self):
        for name in ("toString", "__proto__", "nosuch"):
            self.open(name)
            self.assert_shows_the_answer_of_its_scene()

    def test_an_address_that_holds_no_scene_is_named_and_the_page_goes_on(self):
        for scene in ("pendulum=3", "linkage.links=5", "body_pair=3", "body_pair.spatial=1", "contacts=5",
                      "linkage.links[2].length_m=1", "pendulum.a_m.b=1", "spatial_body.linear_m_s=2",
                      "pendulum.a_m=1&pendulum.b_m=one", "pendulum.a_m", "pendulum.a_m=1%", "restitution=5",
                      "linkage={}", "linkage.links[0]={}", "contacts=[]"):
            self.browser.open("about:blank")
            self.browser.open(f"{self.url}#at=x&{scene}")
            self.settle()
            named = scene.split("&")[-1]
            self.assertEqual(self.text("#about"),
                             f"The address holds no scene, because of {named}: this is one to start from.")
            self.assert_shows_the_answer_of_its_scene()
            self.browser.script("document.querySelector('[data-at=linkage]').click()")
            self.settle()
            self.assertIn("Kane and Levinson", self.text("#about"))

    def test_an_impact_without_an_end_is_neither_possible_nor_impossible(self):
        self.browser.open("about:blank")
        self.browser.open(f"{self.url}#planar_contact.w_tt_per_kg=1&planar_contact.w_tn_per_kg=1"
                          "&planar_contact.w_nn_per_kg=1&planar_contact.tangential_m_s=1"
                          "&planar_contact.normal_m_s=-1&friction.kinetic_coefficient=2&restitution.energetic=0.5")
        self.settle()
        self.assertIn("Wedged", self.text("#sentence"))
        self.assertEqual(self.browser.script("return $('verdict').className"), "bad")
        self.assertEqual(self.text("#state"), "")
        self.assertIn("– no end is known", self.text("#simulator"))
        self.assertIn("has no end", self.text("#possible-note"))

    def test_a_bad_scene_is_refused_with_every_field(self):
        self.open("pendulum")
        self.browser.script("""
          inputs['pendulum.a_m'].number.value = -1;
          inputs['pendulum.a_m'].number.dispatchEvent(new Event('input'));""")
        self.settle()
        self.assertIn("pendulum.a_m = -1: must be > 0", self.text("#leaves"))
        self.assertEqual(self.browser.script("return $('verdict').className"), "bad")
        self.assertEqual(self.text("#motion") + self.text("#possible") + self.text("#simulator"), "")
        for picture in ("course", "energy", "over"):
            self.assertEqual(self.text(f"#{picture} .layer"), "There is no answer for this scene.")

    def test_a_field_without_a_number_is_marked_and_has_no_verdict(self):
        for scene, field, label in (("pendulum", "pendulum.a_m", "a, tip beside pin"),
                                    ("box_on_two_feet", "contacts[1].friction", "contact 2: friction μ")):
            for typed in ("", "1e", "-", "--1", "1,5", "1x10"):
                self.open(scene)
                self.browser.script(f"inputs['{field}'].number.focus(); inputs['{field}'].number.select()")
                for letter in typed or ["\b"]:
                    self.browser.command("Input.dispatchKeyEvent", type="keyDown", windowsVirtualKeyCode=8 if not typed
                                         else 0, text=letter if typed else "")
                self.browser.script(f"inputs['{field}'].number.blur()")
                self.settle()
                self.assertEqual(self.text("#sentence"), f"There is no number in: {label}.", typed)
                self.assertEqual(self.text("#leaves") + self.text("#state") + self.text("#motion") + self.text("#several"),
                                 "")
                self.assertEqual(self.browser.script("return $('verdict').className"), "bad")
                marked = "return [...document.querySelectorAll('[aria-invalid=true]')].length"
                self.assertEqual(self.browser.script(marked), 1)
                self.assertNotIn("NaN", self.browser.script("return location.hash + $('copied').value"))
            # Any control that sets the number ends this.
            self.browser.script(f"inputs['{field}'].slider.value = 0.5;"
                                f"inputs['{field}'].slider.dispatchEvent(new Event('input'));")
            self.settle()
            self.assertEqual(self.browser.script(f"return [inputs['{field}'].number.value, ...[{marked[7:]}]]"),
                             ["0.5", 0])
            self.assertTrue(self.text("#state").startswith("✓"))
        self.assertEqual(self.browser.console(), [])

    def test_a_number_is_a_decimal_that_a_double_holds(self):
        for typed, value in (("0.5", 0.5), (" -1.25e-3 ", -1.25e-3), (".5", 0.5), ("+2.", 2), ("0e9", 0), ("0,5", None),
                             ("0x10", None), ("1e400", None), ("1e-400", None), ("Infinity", None), ("1 2", None)):
            self.assertEqual(self.browser.script(f"return numberIn({json.dumps(typed)})"), value, typed)

    def test_an_address_of_several_contacts_is_that_of_a_box(self):
        self.open("box_on_two_feet")
        box = self.browser.script("return start.scenes.box_on_two_feet")
        two = {"bodies": box["free_bodies"]["bodies"] * 2}
        for scene in ({**box, "free_bodies": two}, {**box, "contacts": box["contacts"][:1]},
                      {"contacts": box["contacts"], "mechanism": {"mass_matrix": [1], "rates": [1]}}):
            fields = self.browser.script(f"return leaves({json.dumps(scene)}).map(field => field.join('=')).join('&')")
            self.open(f"x&{fields}")
            self.assertTrue(self.text("#about").startswith("The address holds no scene"), self.text("#about"))
        self.assertEqual(self.browser.console(), [])

    def test_the_last_change_is_kept_when_another_scene_is_opened_at_once(self):
        self.open("planar_body")
        self.browser.script("change('planar_body.mass_kg', 7);"
                            "document.querySelector('[data-at=linkage]').click()")
        self.assertEqual(self.browser.script("return document.activeElement.dataset.at"), "linkage")
        self.settle()
        self.browser.script("history.back()")
        self.settle()
        self.assertEqual(self.browser.script("return scene.planar_body?.mass_kg"), 7)

    def test_copied_is_said_of_the_text_that_was_copied(self):
        self.open("pendulum")
        self.browser.script("$('copy').click()")
        self.settle()
        self.assertNotEqual(self.text("#copy-state"), "")
        self.browser.script("change('pendulum.a_m', 0.4)")
        self.settle()
        self.assertEqual(self.text("#copy-state"), "")

    def test_pictures_say_their_numbers_to_screen_readers(self):
        self.open("pendulum")
        energy, strip = (self.browser.script(f"return $('{name}').ariaLabel") for name in ("energy", "strip"))
        self.assertRegex(energy, r"^Energy: normal, compression .* J; .*change of energy .* J$")
        self.assertRegex(strip, r"^The regimes over friction: .* from .*")

    def test_nothing_of_an_earlier_scene_is_left(self):
        def show(fields):
            self.browser.script(f"setScene('yours', {json.dumps(fields)}); opened();")
            self.settle()
        rod = {name.split(".")[1]: value for name, value in self.ROD.items()}
        friction = {"friction": {"kinetic_coefficient": 0.3}}
        self.open("spatial_body")
        show({"planar_body": rod, **friction, "whittaker": {"e": 0.5}})
        self.assertEqual(self.text("#over .layer"), "The scene states no coefficient.")
        self.assertEqual(self.text("#over-note") + self.text("#strip"), "")
        self.open("spatial_body")
        self.browser.script("change('spatial_body.mass_kg', -1)")
        self.settle()
        self.assertEqual(self.browser.script("return document.querySelectorAll('#over .handle').length"), 0)
        self.assertEqual(self.text("#over-note") + self.text("#course-note"), "")
        self.assertEqual(self.text("#course-title"), "Routh's diagram")
        # A contact that separates has no coefficients, neither in the table nor beside the controls.
        show({"planar_body": {**rod, "velocity_n_m_s": 3}, **friction, "restitution": {"energetic": 0.8}})
        self.assertEqual(self.browser.script("return [...document.querySelectorAll('#coefficients :is(b, small)')].map("
                                             "one => one.textContent).join('')"), "–––")
        self.assertEqual([row[1] for row in self.rows("possible")[:3]], ["–"] * 3)
        self.assertIn("m/s, each exact (proved).", self.text("#leaves"))
        self.assertNotRegex(self.text("#leaves"), "exact m/s|no known error m/s|each no")

    def test_numbers_that_are_zero_have_controls(self):
        self.browser.open("about:blank")
        self.browser.open(f"{self.url}#at=x&pendulum.a_m=0.3&pendulum.inertia_kg_m2=1&pendulum.omega_minus_rad_s=-1"
                          "&restitution.energetic=0.8")
        self.settle()
        for field in ("pendulum.b_m", "friction.kinetic_coefficient"):
            self.assertEqual(self.browser.script(f"return inputs['{field}'].number.value"), "0")
        self.assert_shows_the_answer_of_its_scene()
        body = "".join(f"&body_pair.spatial.body_{i}.{part}" for i in (1, 2) for part in (
            "mass_kg=1", "inertia_com_kg_m2[0]=1", "inertia_com_kg_m2[1]=1", "inertia_com_kg_m2[2]=1",
            "offset_m[0]=0", "offset_m[1]=0", f"offset_m[2]={2 * i - 3}"))
        self.browser.open("about:blank")
        self.browser.open(f"{self.url}#at=x{body}&restitution.energetic=0.8" +
                          "".join(f"&body_pair.spatial.body_1.linear_m_s[{i}]={value}" for i, value in enumerate((0, 1, 1))))
        self.settle()
        for field in ("body_1.angular_rad_s[2]", "body_2.linear_m_s[0]"):
            self.assertEqual(self.browser.script(f"return inputs['body_pair.spatial.{field}'].number.value"), "0")

    def test_every_field_has_a_name_of_its_own(self):
        for scene in (*SCENES, "box_on_two_feet"):
            self.open(scene)
            labels = self.browser.script("return Object.values(inputs).map(one => one.slider.ariaLabel)")
            self.assertEqual(sorted(set(labels)), sorted(labels))
            self.assertEqual(self.browser.script(
                "return Object.entries(inputs).filter(([f, one]) => Number(one.slider.ariaValueText) !== get(f))"), [])
        self.assertIn("velocity, up m/s", labels)
        self.assertIn("contact 2: point, right m", labels)
        self.assertEqual(self.text("#leaves"), "body_1.x differs by 0.9 m/s between the orders 1 and 2.")
        self.assertFalse(self.browser.script("return $('ghosts').checkVisibility()"))

    def test_every_field_has_the_unit_of_its_name(self):
        for scene, field, unit in (("planar_body", "planar_body.offset_n_m", "[m]"),
                                   ("planar_body", "planar_body.velocity_n_m_s", "[m/s]"),
                                   ("planar_body", "planar_body.offset_t_m", "[m]")):
            self.open(scene)
            shown = self.browser.script(f"return inputs['{field}'].number.parentElement.firstChild.lastChild.textContent")
            self.assertEqual(shown.strip(), unit)

    def test_cost_is_measured_on_demand(self):
        self.open("pendulum")
        self.browser.script("$('measure').click()")
        for _ in range(200):
            if "err by more" in self.text("#cost-state"):
                break
            time.sleep(0.1)
        self.assertRegex(self.text("#cost-state"), "[0-9]+ methods; 0 err by more than they claim")
        self.assertGreater(self.browser.script("return document.querySelectorAll('#front tr').length"), 1)

    def test_a_page_from_elsewhere_cannot_ask(self):
        foreign = DIRECTORY / "foreign.html"
        foreign.write_text("<!DOCTYPE html><title>foreign</title>", encoding="utf-8")
        self.browser.open(foreign.as_uri())
        host, token = re.fullmatch(r"(http://[^/]+)/\?token=(\w+)", self.url).groups()
        for options in ("{method: 'POST', body: '{}'}", "{method: 'POST', body: '{}', headers: {Authorization: 'Bearer " +
                        token + "', 'Content-Type': 'application/json'}}", f"{{mode: 'no-cors'}}"):
            answer = self.browser.post("/execute/async", {"args": [], "script": f"""
              const done = arguments[0];
              fetch('{host}/ricochet.v1.ImpactService/Info?token={token}', {options}).then(
                reply => done(`${{reply.type}} ${{reply.status}}`), error => done(error.message));"""})
            self.assertIn(answer, ("Failed to fetch", "opaque 0"))

    def test_a_finished_page_shows_the_same_without_a_server(self):
        for scene, name in ((["--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "0.9"], "pendulum"),
                            (["--scene", str(DIRECTORY / "copied.textproto")], "ball")):
            self.open(name)
            self.assert_shows_the_answer_of_its_scene()
            shown = {one: self.text(one) for one in ("#sentence", "#leaves", "#motion", "#possible", "#simulator")}
            page = DIRECTORY / "solve.html"
            page.unlink(missing_ok=True)
            ricochet("solve", *scene, "--html", str(page))
            self.assertNotRegex(page.read_text(encoding="utf-8"), r"(?:src|href)=.(?!data:)|@import")
            self.browser.open(page.as_uri())
            self.settle()
            self.assertEqual({one: self.text(one) for one in shown}, shown)
            self.assertEqual(self.browser.script(
                "return [...document.querySelectorAll('input')].filter(input => !input.disabled).length"), 0)
            self.assertEqual(self.browser.script("return performance.getEntriesByType('resource').length"), 0)
            self.browser.screenshot(DIRECTORY / f"solve-{name}.png")
        self.assertEqual(self.browser.console(), [])


if __name__ == "__main__":
    unittest.main()
