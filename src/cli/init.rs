//! `impactid init`: look at the files in a folder and write a commented campaign.toml.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Exit, Failure, Voice};
use crate::campaign::guess::{self, Found};
use crate::campaign::template;
use labfiles::open;
use labfiles::output;

/// Arguments of `impactid init`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Init {
    /// Folder with the records
    #[arg(value_name = "DIR", default_value = ".")]
    folder: PathBuf,
    /// Write over a campaign.toml that is there
    #[arg(long)]
    force: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid init records/      writes records/campaign.toml";

impl Init {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        if !self.folder.is_dir() {
            let message = format!("{} is no folder", self.folder.display());
            return Err(Failure::new(
                message,
                "name the folder that holds the records",
            ));
        }
        let path = self.folder.join("campaign.toml");
        if path.exists() && !self.force {
            return Err(Failure::new(
                format!("{} is there already", path.display()),
                "add --force to write over it",
            ));
        }
        let found = guess::look(&self.folder, &open);
        if found.files == 0 {
            return Err(none_found(&self.folder, &found));
        }
        let text = template::campaign_toml(&name_of(&self.folder), &found);
        output::write_bytes(&path, text.as_bytes())?;
        tell(&path, &found, voice);
        Ok(Exit::Done)
    }
}

fn name_of(folder: &Path) -> String {
    let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf());
    whole.file_name().map_or_else(
        || "campaign".to_owned(),
        |n| n.to_string_lossy().into_owned(),
    )
}

fn none_found(folder: &Path, found: &Found) -> Failure {
    let refused = match found.refused.first() {
        Some((file, why)) => format!("; {file}: {why}"),
        None => String::new(),
    };
    Failure::new(
        format!("no record was found in {}{refused}", folder.display()),
        "name the folder that holds HDF5, CSV, LVM, TDMS, UFF, MATLAB, WAV or Parquet files",
    )
}

fn tell(path: &Path, found: &Found, voice: Voice) {
    for (file, why) in &found.refused {
        voice.detail(&format!("{file} is not a record: {why}"));
    }
    let guessed = found.channels.iter().filter(|c| c.role.is_some()).count();
    voice.say(&format!(
        "{}: {} files ({}), {guessed} of {} channels given a role. Fill it in, then: impactid \
         check {}",
        path.display(),
        found.files,
        found.format,
        found.channels.len(),
        path.display()
    ));
}
