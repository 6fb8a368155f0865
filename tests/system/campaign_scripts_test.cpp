#include "short_campaign.hpp"

#include <gmock/gmock.h>

namespace vigia {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using vigia::testing::read_text;

class CampaignScripts : public ShortCampaign {
 protected:
  void SetUp() override { write_campaign(4); }
  /// Plans into a folder with this name.
  vigia::testing::ProcessResult plan_in(const std::string& name, const std::string& more) const {
    return plan("\"" + (dir_.path() / name).string() + "\"", 4, more);
  }
};

TEST_F(CampaignScripts, OfSlurmAskForTheTimeAndMemoryOfATrial) {
  const auto planned = plan_in("big", "--slurm -j 2");
  ASSERT_EQ(planned.status, 0) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("sbatch " + (dir_.path() / "big/slurm.sh").string()));
  const std::string script = read_text(dir_.path() / "big/slurm.sh");
  EXPECT_THAT(script, ContainsRegex("# A trial took [0-9.]+ s a mission and [0-9]+ MB"));
  EXPECT_THAT(script, HasSubstr("\n#SBATCH --array=1-4\n#SBATCH --cpus-per-task=2\n"));
  EXPECT_THAT(script, ContainsRegex("\n#SBATCH --time=0:0[2-9]:00\n#SBATCH --mem=[1-9][0-9]+M\n"));
  EXPECT_THAT(script, HasSubstr("\n#SBATCH --requeue\n"));
  EXPECT_THAT(script, HasSubstr("big/logs/%a.log\"\n#SBATCH --mail-type=NONE\n"));
}

TEST_F(CampaignScripts, QuoteEveryPath) {
  ASSERT_EQ(plan_in("it's 5%  of \\\"all", "--slurm --parallel").status, 0);
  const auto folder = dir_.path() / "it's 5%  of \"all";
  // The script's own line, with an array task's number, drives the shard.
  const auto ran = vigia::testing::run_process(
      "SLURM_ARRAY_TASK_ID=3 bash '" + dir_.path().string() + "/it'\\''s 5%  of \"all/slurm.sh'",
      dir_.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(std::filesystem::exists(shard(folder, 3)));
  EXPECT_THAT(read_text(folder / "slurm.sh"), HasSubstr("it's 5%%  of \\\"all/logs/%a.log\"\n"));
}

TEST_F(CampaignScripts, OfParallelNameTheHosts) {
  const auto planned = plan_in("big", "--ssh 2/one --ssh 'ssh -F x two'");
  EXPECT_THAT(planned.out, HasSubstr("seq 4 | parallel "));
  EXPECT_THAT(planned.out, HasSubstr(" --sshlogin 2/one --sshlogin 'ssh -F x two' "));
  EXPECT_THAT(planned.out, HasSubstr(read_text(dir_.path() / "big/parallel.sh")));
}

TEST_F(CampaignScripts, OfParallelRefuseABraceInAPath) {
  const auto planned = plan_in("{big}", "--parallel");
  EXPECT_EQ(planned.status, 2);
  EXPECT_THAT(planned.err, HasSubstr("no script can name the path"));
}

}  // namespace
}  // namespace vigia
