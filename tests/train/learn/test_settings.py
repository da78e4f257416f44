from samples import train_settings


def test_the_preset_paper_is_table_2_and_copies_its_target_each_1000_interactions() -> None:
    paper = train_settings(preset="paper")
    table_2 = (paper.interactions, paper.buffer, paper.batch, paper.learning_rate)
    assert table_2 == (350_000, 1_500_000, 512, 5e-5)
    assert (paper.train_frequency, paper.gradient_steps) == (4, 1)
    assert (paper.target_sync * paper.train_frequency, paper.target_rate) == (1_000, 1.0)
    assert (paper.epsilon_start, paper.epsilon_end, paper.epsilon_share) == (1.0, 0.05, 0.1)
    assert paper.double_q
