from samples import train_settings


def test_the_preset_paper_is_table_2_and_copies_its_target_each_1000_interactions() -> None:
    paper = train_settings(preset="paper")
    table_2 = (paper.interactions, paper.buffer, paper.batch, paper.learning_rate)
    assert table_2 == (350_000, 1_500_000, 512, 5e-5)
    assert (paper.train_frequency, paper.gradient_steps) == (4, 1)
    assert (paper.target_sync * paper.train_frequency, paper.target_rate) == (1_000, 1.0)
    assert (paper.epsilon_start, paper.epsilon_end, paper.epsilon_share) == (1.0, 0.05, 0.1)
    assert paper.double_q


def test_the_preset_paper_has_none_of_what_the_default_departs_by() -> None:
    paper = train_settings(preset="paper")
    departures = (
        *(paper.target_acts, paper.clipped_double_q),
        *(paper.clip_targets, paper.value_bounds, paper.leave_loops, paper.reduced_precision),
        *(paper.recent_share, paper.nearby_share, paper.start_jitter, paper.stop_at_success),
    )
    assert not any(departures) and paper.network == "plain"
    assert paper.offline_share < 0 and paper.averaging_rate == 1
    assert paper.discount == 0  # that of the task
