"""EAF as pympi reads it: the same segments as our JSON has, and the same again after pympi wrote it."""

import datetime
import itertools
import json
import unittest
from xml.etree import ElementTree

import pympi

from kinebase_files import InterchangeTest, kinebase

# A name that XML has to escape.
CLASS = "jump & <jack> \"é\""


class ElanTest(InterchangeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        template = cls.folder / "jump.template.json"
        kinebase("learn", cls.clip, "--name", CLASS, "-o", template, "--quiet")
        take = sorted((cls.folder / "synth" / "takes").glob("*.amc"))[0]
        annotate = ["annotate", template, "--in", take, "--tau", "0.2", "--quiet"]
        cls.segments = json.loads(kinebase(*annotate, "--json"))["segments"]
        cls.document = cls.folder / "take.eaf"
        kinebase(*annotate, "-o", cls.document)

    def ours(self):
        """Start and end in whole milliseconds and the class, by time."""
        return [(round(1000 * segment["start_s"]), round(1000 * segment["end_s"]), segment["class"])
                for segment in self.segments]

    def theirs(self, path):
        document = pympi.Elan.Eaf(str(path))
        return sorted(annotation[:3]
                      for tier in document.get_tier_names()
                      for annotation in document.get_annotation_data_for_tier(tier))

    def test_ours_is_read_by_pympi(self):
        self.assertIn(CLASS, [label for _, _, label in self.ours()])
        self.assertEqual(self.theirs(self.document), sorted(self.ours()))

    def test_nothing_is_lost_when_pympi_writes_it(self):
        written = self.folder / "written.eaf"
        pympi.Elan.Eaf(str(self.document)).to_file(str(written))
        self.assertEqual(self.theirs(written), self.theirs(self.document))

    def test_tiers_are_of_a_type_with_times_and_segments_of_a_tier_do_not_overlap(self):
        document = pympi.Elan.Eaf(str(self.document))
        for tier in document.get_tier_names():
            kind = document.get_parameters_for_tier(tier)["LINGUISTIC_TYPE_REF"]
            self.assertEqual(document.linguistic_types[kind]["TIME_ALIGNABLE"], "true")
            times = sorted(document.get_annotation_data_for_tier(tier))
            self.assertTrue(all(a[0] < a[1] for a in times))
            self.assertTrue(all(a[1] <= b[0] for a, b in zip(times, times[1:])))

    def test_elements_and_their_names_are_as_the_format_wants_them(self):
        # What pympi would read all the same: their order, names that are unique, names that exist.
        root = ElementTree.parse(self.document).getroot()
        self.assertEqual([element for element, _ in itertools.groupby(child.tag for child in root)],
                         ["HEADER", "TIME_ORDER", "TIER", "LINGUISTIC_TYPE"])
        datetime.datetime.fromisoformat(root.get("DATE"))
        slots = [slot.get("TIME_SLOT_ID") for slot in root.find("TIME_ORDER")]
        annotations = list(root.iter("ALIGNABLE_ANNOTATION"))
        names = slots + [annotation.get("ANNOTATION_ID") for annotation in annotations]
        self.assertEqual(len(names), len(set(names)))
        self.assertTrue(all(name[0].isalpha() for name in names))
        for annotation in annotations:
            self.assertIn(annotation.get("TIME_SLOT_REF1"), slots)
            self.assertIn(annotation.get("TIME_SLOT_REF2"), slots)
        times = [int(slot.get("TIME_VALUE")) for slot in root.find("TIME_ORDER")]
        self.assertEqual(times, sorted(times))


if __name__ == "__main__":
    unittest.main()
