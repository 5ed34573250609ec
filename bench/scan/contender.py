"""Other programs under the rules of scan_contender.cpp: scans a recording for a template some times
and tells how long each kept the processor busy.

  contender.py CONTENDER TEMPLATE RECORDING RUNS [LAST_ROW]    LAST_ROW gets the accumulated costs of
                                                               paths that end at each column

Costs are numbers of features that disagree: squared Euclidean distances of columns of 0 and 1. What
has to be compiled is compiled in a run before the clock starts.
"""

import json
import sys
import time

import numpy as np

FEATURES = 39


def columns(file):
    """[column, feature] of 0 and 1, from words of 64 bits."""
    words = np.fromfile(file, dtype=np.uint64)
    return ((words[:, None] >> np.arange(FEATURES, dtype=np.uint64)) & np.uint64(1)).astype(float)


class Librosa:
    """Our own recurrence: steps (1,1), (1,2), (2,1), the cheapest path."""

    def prepare(self, query, recording):
        import librosa
        self.dtw = librosa.sequence.dtw
        self.query, self.recording = np.asfortranarray(query.T), np.asfortranarray(recording.T)

    def scan(self):
        return self.dtw(X=self.query, Y=self.recording, metric="sqeuclidean", subseq=True,
                        step_sizes_sigma=np.array([[1, 1], [1, 2], [2, 1]]), backtrack=False)

    def last_row(self, costs):
        return costs[-1]


class Tslearn:
    """Steps (1,0), (0,1), (1,1)."""

    def prepare(self, query, recording):
        from tslearn.metrics import subsequence_cost_matrix
        self.matrix = subsequence_cost_matrix
        self.query, self.recording = query, recording

    def scan(self):
        return self.matrix(self.query, self.recording)

    def last_row(self, costs):
        return np.asarray(costs)[-1]


class Dtaidistance:
    """Steps (1,0), (0,1), (1,1), in C; gives roots of accumulated costs."""

    def prepare(self, query, recording):
        from dtaidistance.subsequence.dtw import SubsequenceAlignment
        self.alignment = SubsequenceAlignment
        self.query, self.recording = np.ascontiguousarray(query), np.ascontiguousarray(recording)

    def scan(self):
        found = self.alignment(self.query, self.recording, penalty=0, use_c=True)
        found.align()
        return found

    def last_row(self, costs):
        return (np.asarray(costs.matching_function()) * len(self.query)) ** 2


CONTENDERS = {"librosa": Librosa, "tslearn": Tslearn, "dtaidistance": Dtaidistance}


def main():
    contender = CONTENDERS[sys.argv[1]]()
    contender.prepare(columns(sys.argv[2]), columns(sys.argv[3]))
    costs = contender.scan()
    if len(sys.argv) > 5:
        np.asarray(contender.last_row(costs), dtype=np.float64).tofile(sys.argv[5])
    seconds = []
    for _ in range(int(sys.argv[4])):
        costs = None
        begin = time.process_time()
        costs = contender.scan()
        seconds.append(time.process_time() - begin)
    print(json.dumps({"seconds": seconds}))


if __name__ == "__main__":
    main()
