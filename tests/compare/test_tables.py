"""The tables of a comparison, from made-up summaries."""

from fcm.compare.tables import costs


def test_a_method_stands_once_where_there_is_nothing_to_leave_out():
    run = {
        "method": "closed form", "max_step": 0.05, "corrected": True, "points": 9, "seconds": 0.1,
        "processor_seconds": 0.1, "start_seconds": None, "table_seconds": None, "evaluations": 20,
    }  # fmt: skip
    runs = [{**run, "left_out": True}, {**run, "left_out": False, "evaluations": 30}]

    def rows(left_out):
        return [
            (row[1], row[-1]) for row in costs({"runs": runs, "max_step": 0.05, "left_out": left_out})[1:]
        ]

    assert rows([]) == [("nothing", "20")]
    assert rows(["contact shroud: held"]) == [("yes", "20"), ("no", "30")]
